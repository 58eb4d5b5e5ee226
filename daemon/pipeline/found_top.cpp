#include "daemon/pipeline/found_top.hpp"

#include "core/base/text.hpp"
#include "core/geometry/se3.hpp"

namespace hulltrack {

std::string quay_keys(const SeenTop& top) {
  return format_text("height = %.3f, slope = [%.2f, %.2f]", top.plane.height, degrees(top.plane.slope.x()),
                     degrees(top.plane.slope.y()));
}

std::string describe_found_top(const SeenTop& top) {
  return "the quay's top, as the joints have it now: " + quay_keys(top) +
         ". From now on a luff or mount that changes against it costs health. When luff, slew and mount have "
         "been checked, write both keys into [quay]: then what is wrong from the start shows, too";
}

}  // namespace hulltrack
