// printf into a std::string: log lines are built in one expression.
//
// Thread rule: pure. Failure: an empty string for a format that the C library rejects.
#pragma once

#include <string>

namespace hulltrack {

[[gnu::format(printf, 1, 2)]] [[nodiscard]] std::string text(const char* format, ...);

}  // namespace hulltrack
