#include "core/base/text.hpp"

#include <cstdarg>
#include <cstdio>

namespace hulltrack {

std::string format_text(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  std::va_list again;
  va_copy(again, arguments);
  const int size = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  std::string line;
  if (size > 0) {
    line.resize(static_cast<std::size_t>(size));
    std::vsnprintf(line.data(), line.size() + 1, format, again);
  }
  va_end(again);
  return line;
}

std::string counted(std::uint64_t number, const char* noun) {
  return std::to_string(number) + ' ' + noun + (number == 1 ? "" : "s");
}

}  // namespace hulltrack
