// Text with figures in it: for reasons, messages and log lines.
//
// Pure; any thread.
#pragma once

#include <cstdint>
#include <string>

namespace hulltrack {

/// printf-style, as long as it needs to be; empty for a format that the C library rejects.
[[gnu::format(printf, 1, 2)]] [[nodiscard]] std::string format_text(const char* format, ...);

/// "1 point", "2 points", "0 points": for English nouns whose plural is in -s.
[[nodiscard]] std::string counted(std::uint64_t number, const char* noun);

}  // namespace hulltrack
