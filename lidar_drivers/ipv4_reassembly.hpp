// IPv4 fragments -> whole datagrams (RFC 791), with bounded memory and no trust in the sender.
//
// At most 16 datagrams are under way at once; the oldest gives way. A datagram with overlapping
// fragments, a size beyond 65,535 bytes or none of its missing parts within 2 s is dropped and its
// fragments counted. Thread rule: one owner.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/time.hpp"

namespace hulltrack {

/// What tells the fragments of one datagram from those of others.
struct FragmentKey {
  std::uint32_t source = 0;
  std::uint32_t destination = 0;
  std::uint16_t identification = 0;
  std::uint8_t protocol = 0;
  bool operator==(const FragmentKey&) const = default;
};

class Ipv4Reassembly {
 public:
  /// Takes one fragment's payload; `offset` in bytes. Returns the whole payload once it is complete (valid
  /// until the next call).
  [[nodiscard]] std::optional<std::span<const std::uint8_t>> add(const FragmentKey& key, std::size_t offset,
                                                                 bool more_fragments,
                                                                 std::span<const std::uint8_t> payload,
                                                                 WallTime stamp);

  /// Fragments thrown away so far.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  /// Fragments that still wait for others.
  [[nodiscard]] std::uint64_t pending() const;

 private:
  struct Part {
    std::size_t begin;
    std::size_t end;
  };
  struct Pending {
    bool active = false;
    bool poisoned = false;  // overlap or oversize: swallow the rest
    FragmentKey key;
    WallTime first_seen{};
    std::vector<Part> parts;
    std::optional<std::size_t> total;
    std::vector<std::uint8_t> bytes;
  };
  [[nodiscard]] Pending& slot_for(const FragmentKey& key, WallTime stamp);
  void drop(Pending& pending);

  std::array<Pending, 16> pending_;
  std::vector<std::uint8_t> complete_;
  std::uint64_t dropped_ = 0;
};

}  // namespace hulltrack
