// Is more of the quay met where another value of one joint, or another mount, would put the machine?
//
// What a return is farther off than QuayMap::kGate belongs to something else. So a joint that is off by a
// metre finds little near the planes of the map that it moves: nothing, or by chance a wall that looks like
// another. Guesses are tried in its stead, two a frame: were this joint off by that much, or the mount turned
// so far, which of the scan's returns would lie on planes? A guess is better when the returns of one class of
// surfaces that it explains are many, spread farther than any face that can be moved is long or tall, and a
// multiple of those that are explained where the machine is said to be, and no other class loses by it. One
// that is promising is asked of the next frames too, until what they show together is enough. A round of
// guesses takes two seconds at 10 Hz.
//
// Frame W; metres, radians. Thread rule: one owner. Cost: 0.1 ms a frame where it is asked.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/integrity/machine_wear.hpp"
#include "core/integrity/misplacement.hpp"
#include "core/integrity/quay_observer.hpp"

namespace hulltrack {

class QuaySearch {
 public:
  /// What leaves the quay in one piece is a lorry or a row of containers, 20 m long at most: what is spread
  /// farther than this does not move. m
  static constexpr float kLongestThing = 25.0F;
  /// What can stand before a wall and be as flat is one face of such a thing: of the side of a
  /// semi-trailer, 13.6 by 4 m, corners are no farther apart than this. m
  static constexpr float kLongestFace = 15.0F;
  /// And nothing on wheels is taller: where roads have a limit it is 4 to 4.95 m. m
  static constexpr float kTallestVehicle = 5.0F;

  /// How many of the returns that are asked, or of a thousand of them, lie on planes of one class.
  struct Met {
    double returns = 0.0;
    double variance_of_root = 0.0;  // of the root of it, since only a sample of them is held against planes
  };
  using MetOfEach = std::array<Met, QuayMap::kClasses>;
  /// Of the newest frame, where the machine is said to be; `seen` is what the observations came to.
  [[nodiscard]] static MetOfEach met(const QuayObservations& observed, const Misplacement& seen);

  /// By JointName, whether an error of the joint that is too large for `seen` to show it would be found:
  /// enough is met, far enough apart, of what such an error moves.
  [[nodiscard]] static std::array<bool, 3> would_find(const QuayObservations& observed,
                                                      const Misplacement& seen, const MachineConfig& machine,
                                                      const MachineStand& stand);

  /// The next guesses; where the quay then lies if one is better. `returns_W`: those of `in_place`, of which
  /// a thousand are asked.
  [[nodiscard]] std::optional<Misplacement> look(const QuayMap& map, const Cloud& returns_W,
                                                 const MachineConfig& machine, const MachineStand& stand,
                                                 const MetOfEach& in_place);
  /// Asks the guess that was better of the next frames too.
  void stay() { inquiries_.at(better_).asked = 1; }

  /// Where the quay lies were the joint off by `amount` (m, rad), if that explains the scan no worse.
  [[nodiscard]] std::optional<Misplacement> look_there(const QuayMap& map, const Cloud& returns_W,
                                                       const MachineConfig& machine,
                                                       const MachineStand& stand, const MetOfEach& in_place,
                                                       JointName joint, double amount);

  /// Begins with the first guess again.
  void forget();

 private:
  using OfEach = std::array<double, QuayMap::kClasses>;
  struct Sight {
    Misplacement seen;                            // about where the machine is said to be
    MetOfEach met{};                              // in the newest frame
    OfEach met_since{};                           // and in those before
    std::array<bool, QuayMap::kClasses> fixed{};  // whether what is met is too large to be moved
  };
  /// What is asked of one guess at a time, for as long as it is promising.
  struct Inquiry {
    QuayObserver observer;
    std::size_t guess = 0;
    int asked = 0;      // frames
    int frames = 0;     // that observer remembers of it
    OfEach in_place{};  // what these met where the machine is said to be

    void begin(std::size_t another);
    void note(const MetOfEach& met_in_place);
    [[nodiscard]] double enough(std::size_t surface) const;
    [[nodiscard]] bool may_be_better(const QuayObservations& observed) const;
    [[nodiscard]] bool promises(const QuayObservations& observed) const;
    [[nodiscard]] bool is_better(const Sight& there) const;
  };
  /// `off`: how the sensor is guessed to be off, about the origin of W. With what was observed before until
  /// the observer forgets.
  [[nodiscard]] const QuayObservations& observe(QuayObserver& observer, const QuayMap& map,
                                                const Cloud& returns_W, const Twist& off);
  [[nodiscard]] static Sight sight_of(const QuayObservations& observed, const Twist& off);

  std::array<Inquiry, 2> inquiries_;
  std::size_t next_guess_ = 0;
  std::size_t better_ = 0;  // the inquiry that found the last one
  QuayObserver there_;      // of one frame
  Cloud moved_W_;           // scratch
};

}  // namespace hulltrack
