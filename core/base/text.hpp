// printf-style text as a string: for reasons, messages and log lines with figures.
//
// As long as it needs to be; empty for a format that the C library rejects. Any thread.
#pragma once

#include <string>

namespace hulltrack {

[[gnu::format(printf, 1, 2)]] [[nodiscard]] std::string format_text(const char* format, ...);

}  // namespace hulltrack
