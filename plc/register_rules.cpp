#include "plc/register_rules.hpp"

#include <algorithm>

namespace hulltrack {
namespace {

constexpr int kRegistersPerRead = 125;  // Modbus Application Protocol V1.1b3, 6.3
constexpr int kWriteRegisters = 40;
constexpr int kAddresses = 65536;

/// Registers that one value of [plc.read] occupies, as offsets.
struct Occupied {
  std::vector<std::string> keys;  // that say where and how many
  int first;
  int count;
  [[nodiscard]] int end() const { return first + count; }
  [[nodiscard]] std::string text() const {
    return count == 1 ? "register " + std::to_string(first)
                      : "registers " + std::to_string(first) + " and " + std::to_string(first + 1);
  }
};

int width(RegisterType type) { return type == RegisterType::int16 || type == RegisterType::uint16 ? 1 : 2; }

Occupied joint_registers(const std::string& section, const JointRegister& joint) {
  return {{section + ".offset", section + ".type"}, joint.offset, width(joint.type)};
}

/// Whether the PLC has a heartbeat is said by its timeout (hulltrackd.toml(5)).
std::vector<Occupied> occupied_registers(const PlcConfig& plc) {
  const PlcReadConfig& read = plc.read;
  std::vector<Occupied> all = {joint_registers("plc.read.travel", read.travel),
                               joint_registers("plc.read.slew", read.slew),
                               joint_registers("plc.read.luff", read.luff)};
  if (plc.heartbeat_timeout > Nanoseconds{0}) {
    all.push_back({{"plc.read.heartbeat"}, read.heartbeat, 1});
    if (read.heartbeat_tail >= 0) {
      all.push_back({{"plc.read.heartbeat_tail"}, read.heartbeat_tail, 1});
    }
  }
  if (read.command >= 0) {
    all.push_back({{"plc.read.command"}, read.command, 1});
  }
  return all;
}

std::vector<std::string> joined(std::vector<std::string> keys, const std::vector<std::string>& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

std::string addresses(int first, int count) {
  return std::to_string(first) + " to " + std::to_string(first + count - 1);
}

}  // namespace

std::vector<BrokenRule> check_registers(const PlcConfig& plc) {
  std::vector<BrokenRule> broken;
  const auto all = occupied_registers(plc);
  std::vector<std::string> all_keys;
  int count = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all_keys = joined(all_keys, all[i].keys);
    count = std::max(count, all[i].end());
    if (all[i].end() > kRegistersPerRead) {
      broken.push_back({all[i].keys, "takes " + all[i].text() + "; one read carries offsets 0 to 124"});
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (all[i].first < all[j].end() && all[j].first < all[i].end()) {
        broken.push_back({joined(all[i].keys, all[j].keys),
                          "takes " + all[i].text() + ", which " + all[j].keys.front() + " takes too (" +
                              all[j].text() + "); give each value registers of its own"});
      }
    }
  }
  const int read_base = plc.read.base;
  const int write_base = plc.write.base;
  if (read_base + count > kAddresses) {
    broken.push_back(
        {{"plc.read.base"},
         "puts the read block at addresses " + addresses(read_base, count) + "; the last address is 65535"});
  }
  if (write_base + kWriteRegisters > kAddresses) {
    broken.push_back({{"plc.write.base"},
                      "puts the write block at addresses " + addresses(write_base, kWriteRegisters) +
                          "; a base of 65496 at most lets its 40 registers fit"});
  }
  if (read_base < write_base + kWriteRegisters && write_base < read_base + count) {
    broken.push_back({joined({"plc.write.base", "plc.read.base"}, all_keys),
                      "puts the write block at addresses " + addresses(write_base, kWriteRegisters) +
                          ", over the read block at " + addresses(read_base, count) +
                          "; move one of them so that they do not overlap"});
  }
  return broken;
}

}  // namespace hulltrack
