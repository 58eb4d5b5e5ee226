// The words that stand for enumerators in the configuration, one list for each enumeration; those of
// the log are its own (daemon/log/log_config.hpp).
//
// In the order of the enumerators, so that an enumerator's value is its word's index.
#pragma once

#include <array>
#include <string_view>

namespace hulltrack {

inline constexpr std::array<std::string_view, 4> kWordOrderWords = {"ABCD", "CDAB", "BADC", "DCBA"};
inline constexpr std::array<std::string_view, 5> kRegisterTypeWords = {"float32", "int32", "uint32", "int16",
                                                                       "uint16"};
inline constexpr std::array<std::string_view, 2> kWriteEncodingWords = {"float32", "int32"};
inline constexpr std::array<std::string_view, 2> kTimeSourceWords = {"receive", "sensor"};
inline constexpr std::array<std::string_view, 2> kFramingWords = {"period", "revolution"};
inline constexpr std::array<std::string_view, 2> kMethodWords = {"auto", "point_to_point"};

}  // namespace hulltrack
