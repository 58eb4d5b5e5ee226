// Is more of the quay met where another value of one joint, or another mount, would put the machine?
//
// Offsets from the map's planes show small errors only: a return farther than QuayMap::kGate off a plane is
// taken to be of something else. Larger errors are found by guesses (machine_guess.hpp). A guess is one error
// of a joint, or one turn of the mount. It moves the scan's returns to where they would lie if it were right.
// - Gained: returns that come to lie near something of the quay's map. Lost: those that no longer do.
//   Surplus: returns gained less those lost. Everything of the map counts, edges and bollards too.
// - Returns inside large level surfaces tell of luff and mount only, so only some of them are counted first.
// - A guess is better if it gains many returns, of many things, and a multiple of what it loses. What it
//   gains has to be spread farther than any movable thing's face is long or tall: a lorry is in no map, and
//   may come to lie on something of the map by chance.
// - The better guess is kept as long as it stays better. The answer is the misplacement that the planes near
//   the moved returns show: another kind of information than the counts.
// - If each wrong guess at a joint loses many returns, a true error of that size would let the right guess
//   gain as many. So the same counts say whether a large error of the joint would be found (would_find()).
//
// Input: a frame's returns beside the hull, and the map. Frame W; metres, radians. Failure: no answer where
// too little is in view. Thread rule: one owner. Cost: 0.15 ms a frame, whatever the map's size; all guesses
// take 1.7 s at 10 Hz.
#pragma once

#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/quay/misplacement.hpp"
#include "core/quay/quay_observer.hpp"
#include "core/witness/machine_guess.hpp"
#include "core/witness/machine_wear.hpp"

namespace hulltrack {

class QuaySearch {
 public:
  /// Surfaces that are spread over more than this are not one movable thing, m. The longest things that leave
  /// a quay in one piece are lorries and rows of containers, 20 m at most.
  static constexpr float kLongestThing = 25.0F;
  /// Returns that are spread over more than this are not of one face of a movable thing, m. The side of a
  /// semi-trailer, 13.6 by 4 m, has a diagonal of less.
  static constexpr float kLongestFace = 15.0F;
  /// Returns that are spread in height over more than this are not of a vehicle, m. Roads with a limit allow
  /// 4 to 4.95 m.
  static constexpr float kTallestVehicle = 5.0F;
  /// An error that moves returns along their plane's normal by less than this is seen as offsets, m: they
  /// stay within the plane's gate even if wear moves them by another 0.2 m.
  static constexpr double kWithinGate = QuayMap::kGate - 0.2F;

  /// Shows it a frame: the returns beside the hull, the observations of planes, and where joints and mount
  /// put the machine. It takes every second frame; every frame while a guess is kept or `closely` is set.
  void see(const QuayMap& map, const Cloud& returns_W, const QuayObservations& observed,
           const MachineConfig& machine, const MachineStand& stand, bool closely);

  struct Elsewhere {
    Misplacement seen;  // of the machine as it stands, from the planes near the moved returns
    MachineGuess guess;
    std::size_t surplus = 0;  // returns gained less those lost
    bool lasting = false;     // the guess has been kept for kLasting frames, half a second
  };
  /// Tries the next guesses on the returns that see() took last. The kept guess and what it shows, if one is
  /// better than the machine's own values.
  [[nodiscard]] std::optional<Elsewhere> look(const QuayMap& map, const MachineConfig& machine);
  struct There {
    bool worse = false;    // more returns are lost than gained, by more than chance
    bool refuted = false;  // it is worse, and the lost returns are spread too far to be of a movable thing
    std::size_t surplus = 0;
    Misplacement seen;  // as Elsewhere::seen; empty where it is worse
  };
  /// What the returns show if the sensor is off by `off`, a twist about the origin of W.
  [[nodiscard]] There look_there(const QuayMap& map, const Twist& off);

  /// Whether guesses would find an error of the joint that is too large to show as offsets from planes. False
  /// until all guesses at the joint have been tried.
  [[nodiscard]] bool would_find(JointName joint) const;

  /// Whether the last frame's planes show an error of this amount as offsets.
  [[nodiscard]] bool shows_as_offset(JointName joint, double amount) const {
    return std::abs(amount) <= shown_up_to_.at(static_cast<std::size_t>(joint));
  }

  /// Drops the returns, the kept guess and all answers of would_find(). Begins with the first guess again.
  void forget();

 private:
  static constexpr int kLasting = 5;  // frames
  /// A return whose place is looked up in the map for each guess.
  struct Asked {
    Point p_W;  // as joints and mount put it
    bool near;  // something of the map is near p_W
  };
  struct Tally {
    std::vector<std::size_t> gained, lost;  // indices of asked_
    std::size_t lost_level = 0;             // returns inside level surfaces that are lost and not in asked_
    [[nodiscard]] std::size_t all_lost() const { return lost.size() + lost_level; }
    void clear() {
      gained.clear();
      lost.clear();
      lost_level = 0;
    }
  };
  void count(const NearCells& things, const Eigen::Isometry3f& moves, std::size_t begin, std::size_t end);
  void count_rest(const NearCells& things, const Eigen::Isometry3f& moves, const Twist& off);
  void tally(const QuayMap& map, const Twist& off);
  void try_guess(const QuayMap& map, const MachineGuess& guess, const Twist& off);
  std::size_t try_guesses(const QuayMap& map, const MachineConfig& machine, std::size_t surplus_of_kept);
  [[nodiscard]] std::size_t surplus() const;
  [[nodiscard]] bool is_fixed(const std::vector<std::size_t>& asked, std::size_t fewest_pieces);
  [[nodiscard]] bool is_better();
  [[nodiscard]] bool loses_as_much(std::size_t counted);
  [[nodiscard]] bool planes_show(const MachineGuess& guess) const;
  void note_planes(const QuayObservations& observed, const MachineConfig& machine);
  [[nodiscard]] Misplacement sight(QuayObserver& observer, const QuayMap& map, const Twist& off);

  bool takes_ = false;      // whether the newest frame's returns were taken
  std::uint32_t turn_ = 0;  // frames taken: changes which returns are asked first
  Cloud returns_W_;         // of the frame that was taken
  MachineStand stand_;
  std::vector<Asked> asked_;
  std::size_t glance_ = 0;                               // stage 1 of a guess counts asked_[0, glance_),
  std::size_t first_ = 0;                                // stage 2 up to first_, stage 3 all the rest
  Cloud inside_level_W_;                                 // returns inside large level surfaces of the map
  std::size_t level_first_ = 0;                          // the first so many of these are in asked_ too
  std::size_t next_ = 0;                                 // number of the guess that is tried next
  std::array<double, kAllJoints.size()> shown_up_to_{};  // errors up to here show as offsets, m, rad
  std::bitset<kMachineGuesses> would_win_;               // an error as large as this guess would be found
  std::optional<std::size_t> kept_;                      // number of the better guess
  int frames_kept_ = 0;
  QuayObserver of_kept_;  // observations at the kept guess
  QuayObserver there_;    // observations of look_there(), of one frame only
  // Scratch:
  std::vector<NearCells::Answer> answers_;
  Tally tally_;
  std::vector<std::uint64_t> pieces_;
  std::vector<float> coordinates_;
  std::vector<double> across_;
  Cloud moved_W_;
};

}  // namespace hulltrack
