#include "core/witness/quay_search.hpp"

#include <algorithm>
#include <cmath>

namespace hulltrack {
namespace {

constexpr std::size_t kGuessesAFrame = 8;

// A guess is tried in three stages: kGlance returns outside of level surfaces; up to kFirst of these and
// kInsideLevel returns inside level surfaces; all others, if the guess has not lost by then.
constexpr std::size_t kGlance = 60;
constexpr std::size_t kFirst = 150;
constexpr std::size_t kInsideLevel = 30;
constexpr QuayObserver::OfClass kOfClass = {30, 30, 30, 30};  // returns compared with planes, of each class

// An observation tells of a joint if this share of the motion that the joint gives it is along the plane's
// normal. So a top that slopes a little does not tell of travel.
constexpr double kTells = 0.25;
constexpr std::size_t kFewestThatTell = 20;

// Returns in one cube of this edge (a piece) count as one thing, m.
constexpr float kPiece = 4.0F;

// A guess is better if it gains kFewestGained returns of kFewestPieces things, and kMuchBetter times what it
// loses. Measured in 190 frames of ten berths of the simulator, with lorries, people, covers and a crane on
// the quay: a wrong guess with eight returns of five things gains at most 1.2 times what it loses, and hardly
// one gains as much as it loses. A right guess gains 20 to 450 returns of 6 to 60 things, and loses a tenth
// of that, whether little or much of the quay is in view.
constexpr std::size_t kFewestGained = 8;
constexpr std::size_t kFewestPieces = 5;
constexpr std::size_t kMuchBetter = 3;
// A guess may be right if it gains so many returns by the end of stage 2, and no fewer than it loses.
constexpr std::size_t kFewestOfFirst = 2;
// A kept guess stays while it gains so many returns, and kMuchBetter times what it loses.
constexpr std::size_t kFewestKept = 4;
// A place is worse if more are lost than gained by so many sigmas of the difference (counts scatter by their
// root). Three frames in a row have to say so (machine_witness.cpp).
constexpr double kSigmas = 2.0;

/// Calls take(index) for at most `most` of `count` indices, evenly spaced, different ones each turn.
template <typename Take>
void take_evenly(std::size_t count, std::size_t most, std::uint32_t turn, Take take) {
  const std::size_t stride = std::max<std::size_t>(1, (count + most - 1) / most);
  for (std::size_t i = turn % stride; i < count; i += stride) {
    take(i);
  }
}

/// From the 10th to the 90th percentile.
float spread(std::vector<float>& values) {
  const auto at = [&](std::size_t rank) {
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
  };
  return values.empty() ? 0.0F : at(values.size() * 9 / 10) - at(values.size() / 10);
}

std::uint64_t piece_of(const Point& p) {
  constexpr int kBits = 21;
  const auto place = [](float v) {
    return static_cast<std::uint64_t>(rounded_down(v * (1.0F / kPiece))) & ((1U << kBits) - 1);
  };
  return (place(p.x()) << (2 * kBits)) | (place(p.y()) << kBits) | place(p.z());
}

}  // namespace

void QuaySearch::see(const QuayMap& map, const Cloud& returns_W, const QuayObservations& observed,
                     const MachineConfig& machine, const MachineStand& stand, bool closely) {
  takes_ = kept_ || closely || !takes_;
  if (!takes_) {
    return;
  }
  ++turn_;
  returns_W_ = returns_W;
  stand_ = stand;
  note_planes(observed, machine);
  const NearCells& things = map.things();
  asked_.clear();
  inside_level_W_.clear();
  answers_.resize(returns_W.size());
  std::transform(returns_W.begin(), returns_W.end(), answers_.begin(),
                 [&things](const Point& p) { return things.at(p); });
  for (std::size_t i = 0; i < returns_W.size(); ++i) {
    const auto [near, inside_level] = answers_[i];
    if (inside_level) {
      inside_level_W_.push_back(returns_W[i]);
    } else if (near || things.in_reach(returns_W[i])) {  // the map says nothing of places out of its reach
      asked_.push_back({returns_W[i], near});
    }
  }
  first_ = 0;
  const auto ask_first = [this](std::size_t i) { std::swap(asked_[first_++], asked_[i]); };
  take_evenly(asked_.size(), kGlance, turn_, ask_first);
  glance_ = first_;
  take_evenly(asked_.size() - glance_, kFirst - kGlance, turn_,
              [&](std::size_t i) { ask_first(glance_ + i); });
  level_first_ = 0;
  take_evenly(inside_level_W_.size(), kInsideLevel, turn_, [&](std::size_t i) {
    asked_.push_back({inside_level_W_[i], true});
    ask_first(asked_.size() - 1);
    std::swap(inside_level_W_[level_first_++], inside_level_W_[i]);
  });
}

/// Adds what asked_[begin, end) gain and lose to the tally. `moves`: from where joints and mount put a return
/// to where the guess does.
void QuaySearch::count(const NearCells& things, const Eigen::Isometry3f& moves, std::size_t begin,
                       std::size_t end) {
  // All cells are read before the first is used, so that the memory accesses overlap.
  answers_.resize(end);
  for (std::size_t i = begin; i < end; ++i) {
    answers_[i] = things.at(moves * asked_[i].p_W);
  }
  for (std::size_t i = begin; i < end; ++i) {
    const bool near = answers_[i].near;
    if (near && !asked_[i].near) {
      tally_.gained.push_back(i);
    } else if (!near && asked_[i].near && things.in_reach(moves * asked_[i].p_W)) {
      tally_.lost.push_back(i);
    }
  }
}

/// Stage 3: the rest of asked_, and the other returns inside level surfaces. A guess that only shifts on the
/// level or turns about the vertical is taken to leave these in their surface: then they are not counted.
void QuaySearch::count_rest(const NearCells& things, const Eigen::Isometry3f& moves, const Twist& off) {
  count(things, moves, first_, asked_.size());
  const bool stays_level = off.head<2>().isZero(0.0) && off[5] == 0.0;
  if (stays_level) {
    return;
  }
  for (std::size_t i = level_first_; i < inside_level_W_.size(); ++i) {
    const Point there_W = moves * inside_level_W_[i];
    tally_.lost_level += !things.at(there_W).near && things.in_reach(there_W) ? 1 : 0;
  }
}

/// All three stages. `off`: the guessed error of the sensor's pose, a twist about the origin of W.
void QuaySearch::tally(const QuayMap& map, const Twist& off) {
  const Eigen::Isometry3f moves(se3_exp(-off).cast<float>());
  tally_.clear();
  count(map.things(), moves, 0, first_);
  count_rest(map.things(), moves, off);
}

/// Counts stage by stage until it is clear that the guess is wrong, and notes whether a joint's error of that
/// size would be found.
void QuaySearch::try_guess(const QuayMap& map, const MachineGuess& guess, const Twist& off) {
  const Eigen::Isometry3f moves(se3_exp(-off).cast<float>());
  tally_.clear();
  count(map.things(), moves, 0, glance_);
  bool clear = tally_.lost.size() > tally_.gained.size() && loses_as_much(first_);
  if (!clear) {
    count(map.things(), moves, glance_, first_);
    const bool may_be_right = tally_.gained.size() >= std::max(kFewestOfFirst, tally_.lost.size());
    clear = !may_be_right && (!guess.joint || planes_show(guess) || loses_as_much(first_));
  }
  if (!clear) {
    count_rest(map.things(), moves, off);
  }
  would_win_[next_] = guess.joint && (clear || planes_show(guess) || loses_as_much(asked_.size()));
}

/// Whether what is lost among the first `counted` of asked_ is, as their share of all, as much as a better
/// guess has to gain (of one piece fewer): then an error of that size would be found.
bool QuaySearch::loses_as_much(std::size_t counted) {
  const double part = double(counted) / double(std::max<std::size_t>(1, asked_.size()));
  return double(tally_.lost.size()) >= part * double(kFewestGained) &&
         is_fixed(tally_.lost, kFewestPieces - 1);
}

/// Whether the error is so small that most observations stay within the gate of their planes, so that offsets
/// show it without a guess.
bool QuaySearch::planes_show(const MachineGuess& guess) const {
  return shows_as_offset(*guess.joint, guess.amount);
}

void QuaySearch::note_planes(const QuayObservations& observed, const MachineConfig& machine) {
  for (const JointName joint : kAllJoints) {
    const Twist twist = joint_twist(machine, stand_, joint, Eigen::Vector3d::Zero());
    across_.clear();
    for (const QuayObservation& o : observed.all) {
      const Eigen::Vector3d moved = about_point(o.p_W, twist).tail<3>();
      if (const double across = std::abs(o.n_W.dot(moved)); across > kTells * moved.norm()) {
        across_.push_back(across);
      }
    }
    const auto middle = across_.begin() + static_cast<std::ptrdiff_t>(across_.size() / 2);
    const bool tells = across_.size() >= kFewestThatTell;
    if (tells) {
      std::nth_element(across_.begin(), middle, across_.end());
    }
    shown_up_to_.at(static_cast<std::size_t>(joint)) = tells ? kWithinGate / *middle : 0.0;
  }
}

/// Whether these returns are of so many pieces, and spread so far, that no movable thing explains them.
bool QuaySearch::is_fixed(const std::vector<std::size_t>& asked, std::size_t fewest_pieces) {
  pieces_.clear();
  for (const std::size_t i : asked) {
    pieces_.push_back(piece_of(asked_[i].p_W));
  }
  std::sort(pieces_.begin(), pieces_.end());
  if (static_cast<std::size_t>(std::unique(pieces_.begin(), pieces_.end()) - pieces_.begin()) <
      fewest_pieces) {
    return false;
  }
  std::array<float, 3> spreads{};
  for (int axis = 0; axis < 3; ++axis) {
    coordinates_.clear();
    for (const std::size_t i : asked) {
      coordinates_.push_back(asked_[i].p_W[axis]);
    }
    spreads.at(static_cast<std::size_t>(axis)) = spread(coordinates_);
  }
  return spreads[2] > kTallestVehicle || std::hypot(spreads[0], spreads[1], spreads[2]) > kLongestFace;
}

bool QuaySearch::is_better() {
  return tally_.gained.size() >= std::max(kFewestGained, kMuchBetter * tally_.all_lost()) &&
         is_fixed(tally_.gained, kFewestPieces);
}

std::size_t QuaySearch::surplus() const {
  return tally_.gained.size() - std::min(tally_.gained.size(), tally_.all_lost());
}

/// Tries the next kGuessesAFrame guesses. The best of them replaces the kept guess if its surplus is larger.
/// Returns the surplus of the guess that is kept then.
std::size_t QuaySearch::try_guesses(const QuayMap& map, const MachineConfig& machine,
                                    std::size_t surplus_of_kept) {
  std::optional<std::size_t> best;
  std::size_t most = surplus_of_kept;
  for (std::size_t i = 0; i < kGuessesAFrame; ++i) {
    const MachineGuess guess = machine_guess(next_);
    try_guess(map, guess, twist_of(guess, machine, stand_));
    if (is_better() && surplus() > most && next_ != kept_) {
      best = next_;
      most = surplus();
    }
    next_ = (next_ + 1) % kMachineGuesses;
  }
  if (best) {
    kept_ = best;
    frames_kept_ = 0;
    of_kept_.forget();
  }
  return most;
}

std::optional<QuaySearch::Elsewhere> QuaySearch::look(const QuayMap& map, const MachineConfig& machine) {
  std::size_t surplus_of_kept = 0;
  if (kept_) {
    tally(map, twist_of(machine_guess(*kept_), machine, stand_));
    surplus_of_kept = surplus();
    ++frames_kept_;
    if (tally_.gained.size() < std::max(kFewestKept, kMuchBetter * tally_.all_lost())) {
      kept_.reset();
      surplus_of_kept = 0;
    }
  }
  const std::size_t surplus = try_guesses(map, machine, surplus_of_kept);
  if (!kept_) {
    return std::nullopt;
  }
  const MachineGuess guess = machine_guess(*kept_);
  return Elsewhere{sight(of_kept_, map, twist_of(guess, machine, stand_)), guess, surplus,
                   frames_kept_ >= kLasting};
}

QuaySearch::There QuaySearch::look_there(const QuayMap& map, const Twist& off) {
  tally(map, off);
  const auto gained = double(tally_.gained.size());
  const auto lost = double(tally_.all_lost());
  if (lost > gained + kSigmas * std::sqrt(gained + lost + 1.0)) {
    return {.worse = true, .refuted = is_fixed(tally_.lost, kFewestPieces), .seen = {}};
  }
  there_.forget();
  return {.surplus = surplus(), .seen = sight(there_, map, off)};
}

/// The misplacement of the machine as it stands, if it is off by about `off` (a twist about the origin of W):
/// what the planes near the moved returns show, plus `off`. The observer adds what it kept of earlier frames.
Misplacement QuaySearch::sight(QuayObserver& observer, const QuayMap& map, const Twist& off) {
  const Eigen::Isometry3f moves(se3_exp(-off).cast<float>());
  moved_W_.resize(returns_W_.size());
  std::transform(returns_W_.begin(), returns_W_.end(), moved_W_.begin(),
                 [&](const Point& p) { return moves * p; });
  Misplacement seen = find_misplacement(observer.observe(map, moved_W_, kOfClass).all);
  const Twist there = about_point(seen.centre_W, off);
  seen.twist += there;
  for (Misplacement::Measurement& measured : seen.measured) {
    measured.offset += measured.direction.dot(there);
  }
  return seen;
}

bool QuaySearch::would_find(JointName joint) const {
  for (std::size_t guess = 0; guess < kMachineGuesses; ++guess) {
    if (!would_win_[guess] && machine_guess(guess).joint == joint) {
      return false;
    }
  }
  return true;
}

void QuaySearch::forget() {
  takes_ = false;
  returns_W_.clear();
  asked_.clear();
  glance_ = 0;
  first_ = 0;
  next_ = 0;
  would_win_.reset();
  kept_.reset();
}

}  // namespace hulltrack
