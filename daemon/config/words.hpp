// The words that stand for enumerators in the configuration, one list for each enumeration.
//
// In the order of the enumerators, so that an enumerator's value is its word's index.
#pragma once

#include <array>
#include <string_view>

#include "core/base/log.hpp"

namespace hulltrack {

inline constexpr std::array<std::string_view, 4> kWordOrderWords = {"ABCD", "CDAB", "BADC", "DCBA"};
inline constexpr std::array<std::string_view, 5> kRegisterTypeWords = {"float32", "int32", "uint32", "int16",
                                                                       "uint16"};
inline constexpr std::array<std::string_view, 2> kWriteEncodingWords = {"float32", "int32"};
inline constexpr std::array<std::string_view, 2> kTimeSourceWords = {"receive", "sensor"};
inline constexpr std::array<std::string_view, 2> kFramingWords = {"period", "revolution"};
inline constexpr std::array<std::string_view, 2> kMethodWords = {"auto", "point_to_point"};
inline constexpr std::array<std::string_view, 9> kFacilityWords = {
    "daemon", "local0", "local1", "local2", "local3", "local4", "local5", "local6", "local7"};
inline constexpr std::array<std::string_view, 5> kLogLevelWords = {"debug", "info", "notice", "warning",
                                                                   "err"};

[[nodiscard]] constexpr std::string_view log_level_name(LogLevel level) {
  return kLogLevelWords[static_cast<std::size_t>(level)];
}

}  // namespace hulltrack
