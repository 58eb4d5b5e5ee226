// Is more of the quay met where another value of one joint, or another mount, would put the machine?
//
// What a return is farther off than QuayMap::kGate belongs to something else. So a joint that is off by a
// metre finds little near the planes of the map that it moves: nothing, or by chance a wall that looks like
// another. Guesses are tried in its stead, some each frame: were this joint off by that much, or the mount
// turned so far, which of the scan's returns would then lie where the map has something, and which no longer?
// Bollards, cabinets, legs and edges tell as well as walls do; what lies inside large level surfaces tells of
// luff and mount alone, so that only some of it is asked. Lorries and people, which are in no map, are met
// nowhere but by chance, and then it is one of them. A guess is better when it gains many returns of many
// things, farther apart than any face that can be moved is long or tall, and a multiple of those that it
// loses. It is kept for as long as it is, and what the returns near planes say there is the answer: two kinds
// of evidence. What every guess at a joint loses in turn is what the true one of them would gain: so the same
// counts say whether a large error of the joint would be found.
//
// Frame W; metres, radians. Thread rule: one owner. Cost: 0.15 ms a frame, whatever the map's size; all
// guesses take 1.7 s at 10 Hz.
#pragma once

#include <array>
#include <bitset>
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
  /// What leaves the quay in one piece is a lorry or a row of containers, 20 m long at most: what is spread
  /// farther than this does not move. m
  static constexpr float kLongestThing = 25.0F;
  /// What can stand where something of the map would be and look like it is one face of such a thing: of the
  /// side of a semi-trailer, 13.6 by 4 m, corners are no farther apart than this. m
  static constexpr float kLongestFace = 15.0F;
  /// And nothing on wheels is taller: where roads have a limit it is 4 to 4.95 m. m
  static constexpr float kTallestVehicle = 5.0F;

  /// A frame's returns beside the hull, what was observed of planes, and where the machine was said to be.
  /// Takes those of every other frame, and of every one while a guess is kept, or to look `closely`.
  void see(const QuayMap& map, const Cloud& returns_W, const QuayObservations& observed,
           const MachineConfig& machine, const MachineStand& stand, bool closely);

  struct Elsewhere {
    Misplacement seen;  // by the planes near returns there
    MachineGuess guess;
    std::size_t surplus = 0;  // of returns that are gained there over those that are lost
    bool lasting = false;     // the guess has been better for half a second
  };
  /// The next guesses, of the returns seen last; where the quay then lies if one is better.
  [[nodiscard]] std::optional<Elsewhere> look(const QuayMap& map, const MachineConfig& machine);
  struct There {
    bool worse = false;    // than in place, by more than chance
    bool refuted = false;  // besides, by what is too large to be moved
    std::size_t surplus = 0;
    Misplacement seen;  // as above; nothing where it is worse
  };
  /// Where the quay lies were the joint off by `amount` (m, rad).
  [[nodiscard]] There look_there(const QuayMap& map, const MachineConfig& machine, JointName joint,
                                 double amount);

  /// Whether an error of the joint that is too large to be seen by offsets from planes would be found. False
  /// until all guesses at it have been tried.
  [[nodiscard]] bool would_find(JointName joint) const;

  /// Begins with the first guess again, and knows of no returns.
  void forget();

 private:
  static constexpr int kLasting = 5;  // frames
  struct Asked {
    Point p_W;
    bool near;  // something of the map, where the machine is said to be
  };
  struct Tally {
    std::vector<std::size_t> gained, lost;  // indices of asked_
    std::size_t lost_level = 0;             // of the rest inside level surfaces
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

  bool takes_ = false;  // the newest frame's returns
  std::uint32_t turn_ = 0;
  Cloud returns_W_;  // of the frame that was taken
  MachineStand stand_;
  std::vector<Asked> asked_;
  std::size_t glance_ = 0;                               // so many of them are asked first,
  std::size_t first_ = 0;                                // and up to here next
  Cloud inside_level_W_;                                 // near, and of no use for most joints
  std::size_t level_first_ = 0;                          // so many of these are among asked_
  std::size_t next_ = 0;                                 // guess
  std::array<double, kAllJoints.size()> shown_up_to_{};  // amounts, m, rad, by the planes
  std::bitset<kMachineGuesses> would_win_;               // that lose as much as they would have to gain
  std::optional<std::size_t> kept_;                      // guess
  int frames_kept_ = 0;
  QuayObserver of_kept_;
  QuayObserver there_;  // of one frame
  // Scratch:
  std::vector<NearCells::Answer> answers_;
  Tally tally_;
  std::vector<std::uint64_t> pieces_;
  std::vector<float> coordinates_;
  std::vector<double> across_;
  Cloud moved_W_;
};

}  // namespace hulltrack
