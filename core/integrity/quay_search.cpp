#include "core/integrity/quay_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/geometry/box.hpp"

namespace hulltrack {
namespace {

/// What may be off: a joint, or the mount turned about an axis of W.
enum class Suspect : std::uint8_t { travel, slew, luff, mount_x, mount_y, mount_z };

struct Guess {
  Suspect suspect;
  double off;  // m, deg
};

/// About the origin of W.
Twist twist_of(const Guess& guess, const MachineConfig& machine, const MachineStand& stand) {
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  if (guess.suspect > Suspect::luff) {
    return radians(guess.off) * mount_twists(stand, origin).at(static_cast<std::size_t>(guess.suspect));
  }
  const auto joint = static_cast<JointName>(guess.suspect);
  return (joint == JointName::travel ? guess.off : radians(guess.off)) *
         joint_twist(machine, stand, joint, origin);
}

// Each reaches half a metre to both sides, as far as pairs do, at the levers of a boom (60 m for walls, 40 m
// for the top). What is nearer than the nearest is seen without a guess; farther off, a slew is beyond
// hull.max_yaw, a luff beyond hull.max_heel and max_trim, and of a travel the walls are seen through.
constexpr Suspect kTravel = Suspect::travel;
constexpr Suspect kSlew = Suspect::slew;
constexpr Suspect kLuff = Suspect::luff;
constexpr Suspect kMountX = Suspect::mount_x;
constexpr Suspect kMountY = Suspect::mount_y;
constexpr Suspect kMountZ = Suspect::mount_z;
constexpr std::array<Guess, 19> kEitherWay = {{
    {kTravel, 1.0}, {kSlew, 0.9},   {kLuff, 1.5},   {kTravel, 2.0}, {kSlew, 1.6},
    {kLuff, 3.0},   {kTravel, 3.0}, {kSlew, 2.3},   {kLuff, 4.5},   {kTravel, 4.0},
    {kSlew, 3.0},   {kTravel, 5.0}, {kSlew, 3.7},   {kMountX, 1.6}, {kMountX, 2.8},
    {kMountY, 1.6}, {kMountY, 2.8}, {kMountZ, 1.6}, {kMountZ, 2.8},
}};
constexpr std::size_t kGuesses = 2 * kEitherWay.size();

Guess guess_number(std::size_t number) {
  const Guess& guess = kEitherWay.at(number / 2);
  return {guess.suspect, number % 2 == 0 ? guess.off : -guess.off};
}

constexpr int kFramesOfAGuess = 6;
constexpr double kKept = 1.0 - 1.0 / QuayObserver::kFrames;  // of earlier frames, as observations are

constexpr QuayObserver::OfClass kOfClass = {30, 30, 30, 30};  // returns that are held against planes

// Where nothing is in its place a sixth of the returns near planes are on them by chance, where all is six
// times as many. Three is the middle of one and six as ratios go.
constexpr double kMuchBetter = 3.0;
// Of each class a true guess explains as much as can be; what it falls short by more than chance of this
// share of what is explained in place is a loss.
constexpr double kLoses = 0.7;
// Too few to place the machine by, offsets tell nevertheless that there may be more to it: these and half of
// all agree with each other; so many a frame, a quarter of what is enough.
constexpr double kPromising = 3.0;
constexpr double kConsenting = 0.5;
constexpr double kSpread = 0.2;  // m: what returns on planes spread over, and the turn of a joint besides

// So many returns a frame, of a thousand, in the mean over the frames of a guess. What stands about a quay
// lies on planes of its map where a guess is wrong as well: in the simulator's berths at up to ten a frame.
constexpr double kFewestAFrame = 12.0;
constexpr int kFewestFrames = 2;
constexpr int kMostFrames = 8;  // QuayObserver::kOfClass returns are these

// What the newest frame meets of a surface is so much larger than what can be moved where it is sure that a
// guess would meet enough of it: as a row of lorries to one of them.
constexpr float kSurely = QuaySearch::kLongestThing / QuaySearch::kLongestFace;

// A surface tells of a joint when it is moved across itself by half of all that it is moved.
constexpr double kTells = 0.5;

constexpr double kSigmas = 3.0;
// Of the returns near planes at least so many are off them by chance, at edges, m.
constexpr double kLeastOff = 0.05;

/// By class, of how many of the observations `counts` says yes.
template <typename Counts>
std::array<double, QuayMap::kClasses> count_by_class(const QuayObservations& observed, Counts counts) {
  std::array<double, QuayMap::kClasses> number{};
  for (const QuayObservation& o : observed.all) {
    number.at(static_cast<std::size_t>(o.surface)) += counts(o) ? 1.0 : 0.0;
  }
  return number;
}

template <typename Holds>
bool any_class(Holds holds) {
  for (std::size_t surface = 0; surface < QuayMap::kClasses; ++surface) {
    if (holds(surface)) {
      return true;
    }
  }
  return false;
}

/// Is the quay explained there no worse than in place? Roots of counts are compared, so that a class that is
/// rare counts as one that is not; what is explained there falls short of what is explained here by no more
/// than chance.
bool no_worse(const QuaySearch::MetOfEach& there, const QuaySearch::MetOfEach& in_place) {
  double more = 0.0;
  double variance = 0.0;
  for (std::size_t surface = 0; surface < there.size(); ++surface) {
    more += std::sqrt(there[surface].returns) - std::sqrt(in_place[surface].returns);
    variance += there[surface].variance_of_root + in_place[surface].variance_of_root;
  }
  return more > -kSigmas * std::sqrt(variance);
}

/// Is less of some class met there than in place, by more than chance?
bool loses_a_class(const QuaySearch::MetOfEach& there, const QuaySearch::MetOfEach& in_place) {
  return any_class([&](std::size_t surface) {
    const double variance = there[surface].variance_of_root + in_place[surface].variance_of_root;
    return std::sqrt(there[surface].returns) <
           std::sqrt(kLoses * in_place[surface].returns) - kSigmas * std::sqrt(variance);
  });
}

/// How far apart the lowest and the highest are of eight in ten of them, m.
float height(Cloud points_W) {
  const auto at = [&](std::size_t rank) {
    const auto nth = points_W.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(points_W.begin(), nth, points_W.end(),
                     [](const Point& a, const Point& b) { return a.z() < b.z(); });
    return nth->z();
  };
  return points_W.empty() ? 0.0F : at(points_W.size() * 9 / 10) - at(points_W.size() / 10);
}

/// By a factor of `margin` at least.
bool too_large_to_be_moved(const Cloud& surface_W, float margin = 1.0F) {
  Box box = Box::none();
  for (const Point& p : surface_W) {
    box.add(p);
  }
  return box.diagonal() > margin * QuaySearch::kLongestFace ||
         height(surface_W) > margin * QuaySearch::kTallestVehicle;
}

/// The most offsets that lie within kSpread of each other.
double most_consenting(std::vector<double>& offsets) {
  std::sort(offsets.begin(), offsets.end());
  std::size_t most = 0;
  for (std::size_t first = 0, last = 0; last < offsets.size(); ++last) {
    while (offsets[last] - offsets[first] > kSpread) {
      ++first;
    }
    most = std::max(most, last - first + 1);
  }
  return double(most);
}

}  // namespace

QuaySearch::MetOfEach QuaySearch::met(const QuayObservations& observed, const Misplacement& seen) {
  const OfEach near = count_by_class(observed, [](const QuayObservation& o) { return o.age == 0; });
  const OfEach on =
      count_by_class(observed, [&](const QuayObservation& o) { return o.age == 0 && seen.agrees(o); });
  MetOfEach met{};
  for (std::size_t surface = 0; surface < met.size(); ++surface) {
    // Of k out of n that were drawn, each for s others, the estimate s k scatters by s sqrt(n p (1 - p)).
    const double s = observed.each_stands_for.at(surface);
    const double off = std::max(kLeastOff, near[surface] > 0.0 ? 1.0 - on[surface] / near[surface] : 0.0);
    met[surface] = {s * on[surface], s * off / 4.0};
  }
  return met;
}

std::array<bool, 3> QuaySearch::would_find(const QuayObservations& observed, const Misplacement& seen,
                                           const MachineConfig& machine, const MachineStand& stand) {
  std::array<Twist, kAllJoints.size()> twists;
  std::array<OfEach, kAllJoints.size()> met{};
  OfEach frames{};  // that there are observations of
  std::array<std::array<Cloud, QuayMap::kClasses>, kAllJoints.size()>
      newest_W;  // as a guess's frames are few
  std::transform(kAllJoints.begin(), kAllJoints.end(), twists.begin(), [&](JointName joint) {
    return joint_twist(machine, stand, joint, Eigen::Vector3d::Zero());
  });
  for (const QuayObservation& o : observed.all) {
    const auto surface = static_cast<std::size_t>(o.surface);
    frames.at(surface) = std::max(frames.at(surface), 1.0 + o.age);
    if (!seen.agrees(o)) {
      continue;
    }
    for (std::size_t joint = 0; joint < twists.size(); ++joint) {
      const Eigen::Vector3d moved = about_point(o.p_W, twists[joint]).tail<3>();
      if (std::abs(o.n_W.dot(moved)) > kTells * moved.norm()) {
        met[joint].at(surface) += observed.each_stands_for.at(surface);
        if (o.age == 0) {
          newest_W[joint].at(surface).push_back(o.p_W.cast<float>());
        }
      }
    }
  }
  std::array<bool, 3> found{};
  for (std::size_t joint = 0; joint < found.size(); ++joint) {
    found[joint] = any_class([&](std::size_t surface) {
      return met[joint][surface] > 0.0 && met[joint][surface] >= kFewestAFrame * frames[surface] &&
             too_large_to_be_moved(newest_W[joint][surface], kSurely);
    });
  }
  return found;
}

const QuayObservations& QuaySearch::observe(QuayObserver& observer, const QuayMap& map,
                                            const Cloud& returns_W, const Twist& off) {
  const Eigen::Isometry3f moves(se3_exp(-off).cast<float>());
  // All of them, or a thousand that lie evenly among them.
  const std::size_t asked = QuayObserver::counted(returns_W.size());
  moved_W_.resize(asked);
  for (std::size_t i = 0; i < asked; ++i) {
    moved_W_[i] = moves * returns_W[i * returns_W.size() / asked];
  }
  return observer.observe(map, moved_W_, 1.0, kOfClass);
}

QuaySearch::Sight QuaySearch::sight_of(const QuayObservations& observed, const Twist& off) {
  Sight sight{.seen = find_misplacement(observed.all)};
  sight.met = met(observed, sight.seen);
  sight.met_since = count_by_class(observed, [&](const QuayObservation& o) { return sight.seen.agrees(o); });
  std::array<Cloud, QuayMap::kClasses> agreeing_W;
  for (const QuayObservation& o : observed.all) {
    if (sight.seen.agrees(o)) {
      agreeing_W.at(static_cast<std::size_t>(o.surface)).push_back(o.p_W.cast<float>());
    }
  }
  for (std::size_t surface = 0; surface < agreeing_W.size(); ++surface) {
    sight.met_since[surface] *= observed.each_stands_for[surface];
    sight.fixed[surface] = too_large_to_be_moved(agreeing_W[surface]);
  }
  const Twist there = about_point(sight.seen.centre_W, off);
  sight.seen.twist += there;
  for (Misplacement::Measurement& measured : sight.seen.measured) {
    measured.offset += measured.direction.dot(there);
  }
  return sight;
}

void QuaySearch::Inquiry::begin(std::size_t another) {
  guess = another;
  asked = 0;
  frames = 0;
  in_place.fill(0.0);
  observer.forget();
}

void QuaySearch::Inquiry::note(const MetOfEach& met_in_place) {
  ++asked;
  frames = std::min(frames + 1, kMostFrames);
  for (std::size_t surface = 0; surface < in_place.size(); ++surface) {
    in_place[surface] = kKept * in_place[surface] + met_in_place[surface].returns;
  }
}

/// So many of a class does a guess have to meet in its frames.
double QuaySearch::Inquiry::enough(std::size_t surface) const {
  return std::max(kFewestAFrame * frames, kMuchBetter * in_place.at(surface));
}

/// Whether it is, if all that lies near planes lies on them: to be asked first, since it costs little.
bool QuaySearch::Inquiry::may_be_better(const QuayObservations& observed) const {
  const OfEach near = count_by_class(observed, [](const QuayObservation&) { return true; });
  return frames >= kFewestFrames && any_class([&](std::size_t surface) {
           return near[surface] * observed.each_stands_for[surface] >= enough(surface);
         });
}

bool QuaySearch::Inquiry::promises(const QuayObservations& observed) const {
  std::array<std::vector<double>, QuayMap::kClasses> offsets;
  for (const QuayObservation& o : observed.all) {
    offsets.at(static_cast<std::size_t>(o.surface)).push_back(o.offset);
  }
  return any_class([&](std::size_t surface) {
    const double consenting = most_consenting(offsets[surface]);
    return consenting > 0.0 && consenting >= kConsenting * double(offsets[surface].size()) &&
           observed.each_stands_for[surface] * consenting >=
               std::max(kPromising * frames, kMuchBetter * in_place[surface]);
  });
}

bool QuaySearch::Inquiry::is_better(const Sight& there) const {
  return frames >= kFewestFrames && any_class([&](std::size_t surface) {
           return there.met_since[surface] >= enough(surface) && there.fixed[surface];
         });
}

std::optional<Misplacement> QuaySearch::look(const QuayMap& map, const Cloud& returns_W,
                                             const MachineConfig& machine, const MachineStand& stand,
                                             const MetOfEach& in_place) {
  for (std::size_t i = 0; i < inquiries_.size(); ++i) {
    Inquiry& inquiry = inquiries_[i];
    if (inquiry.asked == 0 || inquiry.asked >= kFramesOfAGuess) {
      inquiry.begin(next_guess_);
      next_guess_ = (next_guess_ + 1) % kGuesses;
    }
    inquiry.note(in_place);
    const Twist off = twist_of(guess_number(inquiry.guess), machine, stand);
    const QuayObservations& observed = observe(inquiry.observer, map, returns_W, off);
    const bool promising = inquiry.promises(observed);
    bool loses = true;
    if (promising || inquiry.may_be_better(observed)) {
      Sight there = sight_of(observed, off);
      loses = loses_a_class(there.met, in_place);
      if (!loses && inquiry.is_better(there)) {
        better_ = i;
        return std::move(there.seen);
      }
    }
    if (!promising || loses) {
      inquiry.asked = 0;  // another one in the next frame
    }
  }
  return std::nullopt;
}

std::optional<Misplacement> QuaySearch::look_there(const QuayMap& map, const Cloud& returns_W,
                                                   const MachineConfig& machine, const MachineStand& stand,
                                                   const MetOfEach& in_place, JointName joint,
                                                   double amount) {
  const Twist off = amount * joint_twist(machine, stand, joint, Eigen::Vector3d::Zero());
  there_.forget();
  Sight there = sight_of(observe(there_, map, returns_W, off), off);
  return no_worse(there.met, in_place) ? std::optional(std::move(there.seen)) : std::nullopt;
}

void QuaySearch::forget() {
  next_guess_ = 0;
  for (Inquiry& inquiry : inquiries_) {
    inquiry.asked = 0;
  }
}

}  // namespace hulltrack
