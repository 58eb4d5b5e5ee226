#include "core/integrity/quay_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/geometry/box.hpp"

namespace hulltrack {
namespace {

struct Guess {
  JointName joint;
  double reads_too_much;  // m, deg
  [[nodiscard]] double amount() const {
    return joint == JointName::travel ? reads_too_much : radians(reads_too_much);
  }
};

// Each reaches half a metre to both sides, as far as pairs do: 0.75 deg at a lever of 40 m. What is nearer
// than the nearest is seen without a guess; farther off, a slew is beyond hull.max_yaw, a luff beyond
// hull.max_heel and max_trim, and of a travel the walls are seen through.
constexpr JointName kTravel = JointName::travel;
constexpr JointName kSlew = JointName::slew;
constexpr JointName kLuff = JointName::luff;
constexpr std::array<Guess, 20> kGuesses = {{
    {kTravel, 1.0}, {kTravel, -1.0}, {kSlew, 1.5},    {kSlew, -1.5},   {kLuff, 1.5},
    {kLuff, -1.5},  {kTravel, 2.0},  {kTravel, -2.0}, {kSlew, 3.0},    {kSlew, -3.0},
    {kLuff, 3.0},   {kLuff, -3.0},   {kTravel, 3.0},  {kTravel, -3.0}, {kLuff, 4.5},
    {kLuff, -4.5},  {kTravel, 4.0},  {kTravel, -4.0}, {kTravel, 5.0},  {kTravel, -5.0},
}};

constexpr QuaySight::Sample kSample = {QuaySight::kLookedUp, {30, 30, 30, 30}};

// Where nothing is in its place a sixth of the returns near planes are on them by chance, where all is six
// times as many. Three is the middle of one and six as ratios go, and at ten returns three sigma off either.
constexpr double kMuchBetter = 3.0;
constexpr double kFewest = 10.0;
// Of no class a wrong guess explains more than chance does, and a true one as much as there is.
constexpr double kLoses = 0.5;

// A surface tells of a joint when it is moved across itself by half of all that it is moved.
constexpr double kTells = 0.5;

// The root of a count scatters by a half, whatever the count; three times that is no chance.
constexpr double kByChance = 1.5;

/// How much more of the quay is met there, in roots of counts: of a class that is rare as of one that is not.
double more(const QuaySearch::Met& there, const QuaySearch::Met& in_place) {
  double sum = 0.0;
  for (std::size_t surface = 0; surface < there.size(); ++surface) {
    sum += std::sqrt(there[surface]) - std::sqrt(in_place[surface]);
  }
  return sum;
}

class Extent {
 public:
  void add(const Point& p) { box_ = box_ ? Box{box_->min.cwiseMin(p), box_->max.cwiseMax(p)} : Box{p, p}; }
  [[nodiscard]] float length() const { return box_ ? (box_->max - box_->min).norm() : 0.0F; }

 private:
  std::optional<Box> box_;
};

}  // namespace

QuaySearch::QuaySearch(bool has_region) : sight_(has_region, kSample) {}

QuaySearch::Met QuaySearch::met(const QuaySighting& sighting, const Misplacement& seen) {
  Met met{};
  for (const QuayObservation& o : sighting.observations) {
    const auto surface = static_cast<std::size_t>(o.surface);
    met.at(surface) += o.newest && seen.agrees(o) ? sighting.each_stands_for.at(surface) : 0.0;
  }
  return met;
}

bool QuaySearch::would_find(JointName joint, const QuaySighting& sighting, const Misplacement& seen,
                            const MachineConfig& machine, const MachineStand& stand) {
  const Twist twist = joint_twist(machine, stand, joint, Eigen::Vector3d::Zero());
  double met = 0.0;  // in this frame
  Extent extent;     // in the last ones
  for (const QuayObservation& o : sighting.observations) {
    const Eigen::Vector3d moved = twist.tail<3>() + twist.head<3>().cross(o.p_W);
    if (seen.agrees(o) && std::abs(o.n_W.dot(moved)) > kTells * moved.norm()) {
      met += o.newest ? sighting.each_stands_for.at(static_cast<std::size_t>(o.surface)) : 0.0;
      extent.add(o.p_W.cast<float>());
    }
  }
  return met >= kFewest && extent.length() > kLongestThing;
}

QuaySearch::Sight QuaySearch::sight_of(const QuayMap& map, const FilteredScan& scan,
                                       const MachineConfig& machine, const MachineStand& stand,
                                       JointName joint, double amount) {
  const Twist moves = amount * joint_twist(machine, stand, joint, Eigen::Vector3d::Zero());
  const QuaySighting& sighting = sight_.look_elsewhere(map, scan, se3_exp(moves).inverse());
  Sight sight{.seen = find_misplacement(sighting.observations)};
  sight.met = met(sighting, sight.seen);
  std::array<Extent, QuayMap::kClasses> extents;
  for (const QuayObservation& o : sighting.observations) {
    if (sight.seen.agrees(o)) {
      extents.at(static_cast<std::size_t>(o.surface)).add(o.p_W.cast<float>());
    }
  }
  std::transform(extents.begin(), extents.end(), sight.extent.begin(),
                 [](const Extent& extent) { return extent.length(); });
  const Twist there = amount * joint_twist(machine, stand, joint, sight.seen.centre_W);
  sight.seen.twist += there;
  for (Misplacement::Measurement& measured : sight.seen.measured) {
    measured.offset += measured.direction.dot(there);
  }
  return sight;
}

std::optional<Misplacement> QuaySearch::look(const QuayMap& map, const FilteredScan& scan,
                                             const MachineConfig& machine, const MachineStand& stand,
                                             const Met& in_place) {
  const Guess& guess = kGuesses[guess_];
  Sight there = sight_of(map, scan, machine, stand, guess.joint, guess.amount());
  bool better = false;
  bool worse = false;
  for (std::size_t surface = 0; surface < there.met.size(); ++surface) {
    better =
        better || (there.met[surface] >= kFewest && there.met[surface] > kMuchBetter * in_place[surface] &&
                   there.extent[surface] > kLongestThing);
    worse = worse || there.met[surface] < kLoses * in_place[surface];
  }
  if (!better || worse) {
    guess_ = (guess_ + 1) % kGuesses.size();
    return std::nullopt;
  }
  return std::move(there.seen);
}

std::optional<Misplacement> QuaySearch::look_there(const QuayMap& map, const FilteredScan& scan,
                                                   const MachineConfig& machine, const MachineStand& stand,
                                                   const Met& in_place, JointName joint, double amount) {
  Sight there = sight_of(map, scan, machine, stand, joint, amount);
  if (more(there.met, in_place) > -kByChance) {
    return std::move(there.seen);
  }
  return std::nullopt;
}

}  // namespace hulltrack
