#include "core/base/text.hpp"

#include <cstdarg>
#include <cstdio>

namespace hulltrack {

std::string format_text(const char* format, ...) {
  char buffer[241];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

}  // namespace hulltrack
