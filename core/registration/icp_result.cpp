#include "core/registration/icp_result.hpp"

namespace hulltrack {

const char* describe(IcpStop stop) {
  switch (stop) {
    case IcpStop::converged:
      return "converged";
    case IcpStop::iteration_limit:
      return "still moving at the iteration limit";
    case IcpStop::too_few_matches:
      return "fewer than three points match the map";
    case IcpStop::degenerate_geometry:
      return "the matched points lie on one line";
    case IcpStop::invalid_start:
      return "the start pose is not finite";
  }
  return "unknown";
}

}  // namespace hulltrack
