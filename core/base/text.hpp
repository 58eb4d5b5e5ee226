// printf-style text as a string: for reasons and messages with figures.
//
// One line, at most 240 characters (longer text is cut). Any thread.
#pragma once

#include <string>

namespace hulltrack {

[[gnu::format(printf, 1, 2)]] [[nodiscard]] std::string format_text(const char* format, ...);

}  // namespace hulltrack
