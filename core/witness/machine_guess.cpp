#include "core/witness/machine_guess.hpp"

#include <array>
#include <cstdint>

namespace hulltrack {
namespace {

/// What may be off: a joint, or the mount turned about an axis of W.
enum class Suspect : std::uint8_t { travel, slew, luff, mount_x, mount_y, mount_z };

/// `count` amounts, `step` apart from `first` on, each with both signs; m or deg.
struct Series {
  Suspect suspect;
  double first, step;
  std::size_t count;
};
constexpr std::array<Series, 6> kSeries = {{{Suspect::travel, 0.55, 0.35, 15},
                                            {Suspect::slew, 0.7, 0.3, 11},
                                            {Suspect::luff, 1.2, 0.3, 14},
                                            {Suspect::mount_x, 1.2, 0.3, 9},
                                            {Suspect::mount_y, 1.2, 0.3, 9},
                                            {Suspect::mount_z, 1.2, 0.3, 9}}};

struct Guess {
  Suspect suspect = Suspect::travel;
  double off = 0.0;    // m, deg
  bool first = false;  // it has the smallest amount of its series
};

/// The smallest amounts of all series first, then the next ones.
constexpr std::array<Guess, kMachineGuesses> kGuesses = [] {
  std::array<Guess, kMachineGuesses> guesses{};
  std::size_t number = 0;
  for (std::size_t step = 0; number < guesses.size(); ++step) {
    for (const Series& series : kSeries) {
      if (step < series.count) {
        const double off = series.first + static_cast<double>(step) * series.step;
        guesses.at(number++) = {series.suspect, off, step == 0};
        guesses.at(number++) = {series.suspect, -off, step == 0};
      }
    }
  }
  return guesses;
}();

}  // namespace

MachineGuess machine_guess(std::size_t number) {
  const Guess& guess = kGuesses.at(number);
  const bool is_joint = guess.suspect <= Suspect::luff;
  return {.joint = is_joint ? std::optional(static_cast<JointName>(guess.suspect)) : std::nullopt,
          .axis = is_joint ? 0 : static_cast<int>(guess.suspect) - static_cast<int>(Suspect::mount_x),
          .amount = guess.suspect == Suspect::travel ? guess.off : radians(guess.off),
          .beyond_wear = !guess.first};
}

Twist twist_of(const MachineGuess& guess, const MachineConfig& machine, const MachineStand& stand) {
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  constexpr int kTurns = 3;  // index of the first turn in mount_twists(): three shifts come before
  return guess.amount * (guess.joint
                             ? joint_twist(machine, stand, *guess.joint, origin)
                             : mount_twists(stand, origin).at(static_cast<std::size_t>(kTurns + guess.axis)));
}

}  // namespace hulltrack
