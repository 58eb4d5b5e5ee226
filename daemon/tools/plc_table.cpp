#include "daemon/tools/plc_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/text.hpp"
#include "daemon/tools/tools.hpp"
#include "plc/modbus_link.hpp"
#include "plc/register_codec.hpp"

namespace hulltrack {
namespace {

constexpr std::array<std::pair<WordOrder, const char*>, 4> kOrders{{{WordOrder::abcd, "ABCD"},
                                                                    {WordOrder::cdab, "CDAB"},
                                                                    {WordOrder::badc, "BADC"},
                                                                    {WordOrder::dcba, "DCBA"}}};
/// On a ladder nobody minds a second; a gateway to a serial line may need it.
constexpr std::chrono::milliseconds kAnswerTime{1000};
constexpr int kAttempts = 3;

RegisterPair pair_at(std::span<const std::uint16_t> registers, std::size_t at) {
  return {registers[at], registers[at + 1]};
}

/// "HOST", "HOST:PORT" or "[IPv6]:PORT".
ModbusLinkConfig link_config(const std::string& address, int unit_id) {
  ModbusLinkConfig config{.host = address, .unit_id = unit_id, .response_timeout = kAnswerTime};
  const auto colon = address.rfind(':');
  const bool one_colon = colon != std::string::npos && address.find(':') == colon;
  const bool bracketed = address.starts_with('[') && colon != std::string::npos && address[colon - 1] == ']';
  if (!one_colon && !bracketed) return config;
  unsigned port = 0;
  const char* end = address.data() + address.size();
  const auto parsed = std::from_chars(address.data() + colon + 1, end, port);
  if (parsed.ec != std::errc{} || parsed.ptr != end || port == 0 || port > 65535)
    throw ToolError(kExitUsage,
                    "--plc " + address + ": give HOST or HOST:PORT, 192.168.10.10:502 for example");
  config.host = bracketed ? address.substr(1, colon - 2) : address.substr(0, colon);
  config.port = static_cast<std::uint16_t>(port);
  return config;
}

std::vector<std::uint16_t> read_registers(const std::string& address, int unit_id, int base, int count) {
  const ModbusLinkConfig config = link_config(address, unit_id);
  ModbusLink link(config);
  std::vector<std::uint16_t> registers(static_cast<std::size_t>(count));
  LinkResult result;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    link.end_back_off();
    result = link.read(base, registers, "--base");
    if (result.ok()) return registers;
    if (result.link_up()) break;  // it answered: with a refusal
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  throw ToolError(
      format_text("the PLC at %s port %u: %s", config.host.c_str(), config.port, result.message.c_str()));
}

}  // namespace

std::vector<WordOrder> plausible_word_orders(std::span<const std::uint16_t> registers) {
  std::vector<WordOrder> plausible;
  const bool any = std::ranges::any_of(registers, [](std::uint16_t value) { return value != 0; });
  for (const auto& [order, name] : kOrders) {
    bool all = any;
    for (std::size_t at = 0; at + 1 < registers.size(); at += 2) {
      const RegisterPair pair = pair_at(registers, at);
      const float size = std::abs(decode_float32(pair, order));
      all = all && ((pair[0] == 0 && pair[1] == 0) || (size >= 1e-4F && size <= 1e4F));
    }
    if (all) plausible.push_back(order);
  }
  return plausible;
}

void print_plc_table(const std::string& address, int unit_id, int base, int count) {
  const std::vector<std::uint16_t> registers = read_registers(address, unit_id, base, count);
  std::printf("PLC %s, unit %d, holding registers from %d on\n", address.c_str(), unit_id, base);
  std::printf("%8s %7s %7s", "offset", "hex", "int16");
  for (const auto& [order, name] : kOrders) std::printf(" %14s", name);
  std::printf("\n");
  for (std::size_t at = 0; at < registers.size(); ++at) {
    std::printf("%8zu  0x%04X %7d", at, unsigned{registers[at]},
                int{static_cast<std::int16_t>(registers[at])});
    if (at % 2 == 0 && at + 1 < registers.size())
      for (const auto& [order, name] : kOrders)
        std::printf(" %14.6g", static_cast<double>(decode_float32(pair_at(registers, at), order)));
    std::printf("\n");
  }
  // Travel, slew and luff; what follows them are words.
  const auto joints = std::span(registers).first(std::min<std::size_t>(6, registers.size()));
  const auto orders = plausible_word_orders(joints);
  std::string names;
  for (const auto& [order, name] : kOrders)
    if (std::ranges::find(orders, order) != orders.end())
      names += (names.empty() ? "" : " or ") + std::string(name);
  const bool all_zero = std::ranges::all_of(joints, [](std::uint16_t value) { return value == 0; });
  if (all_zero) {
    std::printf(
        "  verdict      the first %zu registers are 0\n"
        "  next         move the machine and look again, or try another --base\n",
        joints.size());
  } else if (names.empty()) {
    std::printf(
        "  verdict      no float32 joint under any word order\n"
        "  next         is it int16 or int32 (`type`), or another --base?\n");
  } else {
    std::printf(
        "  verdict      joints in float32 with word order %s\n"
        "  next         [plc.read] base = %d, word_order = ...; compare with the machine's display\n",
        names.c_str(), base);
  }
}

}  // namespace hulltrack
