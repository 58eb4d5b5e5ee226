#include "lidar_drivers/decoder.hpp"

namespace hulltrack {

const char* return_mode_name(ReturnMode mode) {
  switch (mode) {
    case ReturnMode::strongest:
      return "strongest";
    case ReturnMode::last:
      return "last";
    case ReturnMode::first:
      return "first";
    case ReturnMode::dual:
      return "dual";
    case ReturnMode::triple:
      return "triple";
    case ReturnMode::unknown:
      break;
  }
  return "unknown";
}

}  // namespace hulltrack
