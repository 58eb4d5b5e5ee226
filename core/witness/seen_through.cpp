#include "core/witness/seen_through.hpp"

#include <algorithm>
#include <cstddef>

#include "core/base/text.hpp"
#include "core/geometry/box.hpp"
#include "core/witness/quay_search.hpp"

namespace hulltrack {
namespace {

// The machine is charged if rays pass through more than this share of a class of planes, of kFewestReached
// at least. Rays pass through a plane's true place only if what stood there has left (a lorry, a stack of
// covers), and half of a class does not leave within a tide. With all in place it is one plane in a hundred,
// at an edge: hardly ever half of twelve.
constexpr double kMostSeenThrough = 0.5;
constexpr double kFewestReached = 12.0;
constexpr std::size_t kRemembered = 100;  // places of planes seen through, of each class
// The sums of Memory lose 5 % a frame: they cover some twenty frames, two seconds.
constexpr double kFading = 0.95;

float extent(const std::deque<Point>& points) {
  Box box = Box::none();
  for (const Point& p : points) {
    box.add(p);
  }
  return box.diagonal();
}

}  // namespace

void SeenThrough::remember(const QuaySighting& sighting) {
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    planes_[i].reached = kFading * planes_[i].reached + sighting.planes[i].reached;
    planes_[i].now = sighting.planes[i].reached > 0;
    const Cloud& through_W = sighting.planes[i].seen_through_W;
    planes_[i].through = kFading * planes_[i].through + double(through_W.size());
    std::deque<Point>& where_W = planes_[i].where_W;
    where_W.insert(where_W.end(), through_W.begin(), through_W.end());
    where_W.erase(where_W.begin(),
                  where_W.end() - static_cast<std::ptrdiff_t>(std::min(where_W.size(), kRemembered)));
  }
}

std::string SeenThrough::complaint() const {
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const Memory& of_class = planes_[i];
    if (of_class.now && of_class.reached >= kFewestReached &&
        of_class.through > kMostSeenThrough * of_class.reached &&
        extent(of_class.where_W) > QuaySearch::kLongestThing) {
      return format_text(
          "the scan sees through %.0f %% of the quay's %s surfaces where joints and mount put them",
          100.0 * of_class.through / of_class.reached, surface_class_name(static_cast<SurfaceClass>(i)));
    }
  }
  return {};
}

}  // namespace hulltrack
