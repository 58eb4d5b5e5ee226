#include "lidar_drivers/ipv4_reassembly.hpp"

#include <algorithm>

namespace hulltrack {

namespace {
constexpr std::size_t kMaxDatagram = 65'535;
constexpr std::size_t kMaxParts = 256;
constexpr Nanoseconds kPatience = std::chrono::seconds(2);
}  // namespace

std::optional<std::span<const std::uint8_t>> Ipv4Reassembly::add(const FragmentKey& key, std::size_t offset,
                                                                 bool more_fragments,
                                                                 std::span<const std::uint8_t> payload,
                                                                 WallTime stamp) {
  Pending& pending = slot_for(key, stamp);
  const Part part{offset, offset + payload.size()};
  pending.parts.push_back(part);
  if (pending.poisoned) {
    drop(pending);
    pending.poisoned = true;
    return std::nullopt;
  }

  const auto others = std::span(pending.parts).first(pending.parts.size() - 1);
  const bool overlaps = std::ranges::any_of(
      others, [&](const Part& other) { return part.begin < other.end && other.begin < part.end; });
  const bool beyond_end = pending.total && (part.end > *pending.total || !more_fragments);
  const bool cuts_others =
      !more_fragments && std::ranges::any_of(others, [&](const Part& other) { return other.end > part.end; });
  if (payload.empty() || part.end > kMaxDatagram || pending.parts.size() > kMaxParts || overlaps ||
      beyond_end || cuts_others) {
    drop(pending);
    pending.poisoned = true;
    return std::nullopt;
  }

  if (!more_fragments) pending.total = part.end;
  if (pending.bytes.size() < part.end) pending.bytes.resize(part.end);
  std::ranges::copy(payload, pending.bytes.begin() + static_cast<std::ptrdiff_t>(offset));

  std::size_t have = 0;  // parts do not overlap, so their lengths add up
  for (const Part& p : pending.parts) have += p.end - p.begin;
  if (!pending.total || have != *pending.total) return std::nullopt;
  complete_.swap(pending.bytes);
  complete_.resize(*pending.total);
  pending.active = false;
  return std::span<const std::uint8_t>(complete_);
}

std::uint64_t Ipv4Reassembly::pending() const {
  std::uint64_t count = 0;
  for (const Pending& p : pending_) count += p.active ? p.parts.size() : 0;
  return count;
}

Ipv4Reassembly::Pending& Ipv4Reassembly::slot_for(const FragmentKey& key, WallTime stamp) {
  const auto same =
      std::ranges::find_if(pending_, [&](const Pending& p) { return p.active && p.key == key; });
  if (same != pending_.end()) {
    const bool stale = std::chrono::abs(stamp - same->first_seen) > kPatience;
    if (!stale) return *same;
  }
  const auto idle = std::ranges::find_if(pending_, [](const Pending& p) { return !p.active; });
  Pending& slot = same != pending_.end()   ? *same
                  : idle != pending_.end() ? *idle
                                           : *std::ranges::min_element(pending_, {}, &Pending::first_seen);
  if (slot.active) drop(slot);
  slot.active = true;
  slot.poisoned = false;
  slot.key = key;
  slot.first_seen = stamp;
  slot.parts.clear();
  slot.total.reset();
  slot.bytes.clear();
  return slot;
}

void Ipv4Reassembly::drop(Pending& pending) {
  dropped_ += pending.parts.size();
  pending.parts.clear();
}

}  // namespace hulltrack
