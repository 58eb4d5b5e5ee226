// What a site says of the log: [log] of the configuration (ICD 5) as plain values, and the words for them.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "daemon/log/log.hpp"

namespace hulltrack {

struct LogConfig {
  std::string ident = "hulltrackd";
  std::string facility = "daemon";  // daemon, local0 .. local7
  LogLevel level = LogLevel::info;  // lines below it are not written
};

inline constexpr std::array<std::string_view, 9> kFacilityWords = {
    "daemon", "local0", "local1", "local2", "local3", "local4", "local5", "local6", "local7"};
/// In the order of LogLevel.
inline constexpr std::array<std::string_view, 5> kLogLevelWords = {"debug", "info", "notice", "warning",
                                                                   "err"};

[[nodiscard]] constexpr std::string_view log_level_name(LogLevel level) {
  return kLogLevelWords[static_cast<std::size_t>(level)];
}

}  // namespace hulltrack
