// The scenarios that are about seeing the ship: a covered window, weather, clutter, a loader in a hurry.
#include <numbers>

#include "daemon/simulator/run/scenario_groups.hpp"
#include "daemon/simulator/ship/ship_conduct.hpp"

namespace hulltrack {
namespace {

using conduct::sheltered;
using conduct::shifted;
using conduct::with;

constexpr double kWholeWindow = 2.0 * std::numbers::pi;

/// Works as ever, but pours longer.
LoaderLimits pouring_long() {
  LoaderLimits limits = loader_limits();
  limits.shortest_pour = 6.0;
  limits.longest_pour = 12.0;
  return limits;
}

Weather rain(double false_share, double drop_out, double range_sigma, const Spells& when = {}) {
  return {.when = when, .false_share = false_share, .drop_out = drop_out, .range_sigma = range_sigma};
}

void add_blinded(std::vector<Scenario>& all) {
  all.push_back(
      {.name = "warp-blind",
       .sentence = "Warped by one hatch at 0.3 m/s while the window is covered; it is uncovered at 87 s.",
       .frames = 950,
       .motion = with(sheltered(), {shifted(3.0, {conduct::kHatchPitch, 0.0, 0.0}, 0.3, 0.06)}),
       .cover = {.when = {.first = 2.0, .length = 85.0}, .width = kWholeWindow}});
  all.push_back(
      {.name = "drift-blind",
       .sentence = "Drifts 6 m ahead, 0.8 m off and 1.5 m down during a minute with the window covered.",
       .frames = 720,
       .motion = with(sheltered(), {shifted(5.0, {6.0, 0.8, -1.5}, 0.2, 0.02)}),
       .cover = {.when = {.first = 3.0, .length = 60.0}, .width = kWholeWindow}});
  all.push_back({.name = "blind-short",
                 .sentence = "The window is covered from 4 to 14 s; the ship stays where she is.",
                 .frames = 200,
                 .motion = sheltered(),
                 .cover = {.when = {.first = 4.0, .length = 10.0}, .width = kWholeWindow}});
  all.push_back({.name = "blocked-window",
                 .sentence = "Half of the field of view goes blind at 8 s and sees again at 23 s.",
                 .frames = 300,
                 .motion = sheltered(),
                 .cover = {.when = {.first = 8.0, .length = 15.0}, .width = 0.5 * kWholeWindow}});
}

void add_seen_badly(std::vector<Scenario>& all) {
  const auto add = [&](std::string_view name, std::string_view sentence, int frames, const Weather& weather) {
    all.push_back(
        {.name = name, .sentence = sentence, .frames = frames, .motion = sheltered(), .weather = weather});
  };
  add("rain", "10 % of the beams end on drops, 20 % are lost, range noise 3 cm.", 300, rain(0.1, 0.2, 0.03));
  add("rain-heavy", "30 % of the beams end on drops, 60 % are lost, range noise 5 cm.", 200,
      rain(0.3, 0.6, 0.05));
  add("fog", "Nothing is seen beyond 30 m, and less the farther it is.", 200,
      {.when = {}, .visibility = 30.0});
  all.push_back({.name = "dust",
                 .sentence = "A plume of dust around the chute's end comes and goes with the pouring.",
                 .frames = 400,
                 .motion = sheltered(),
                 .dust = 0.4,
                 .loader = pouring_long()});
  all.push_back({.name = "crane",
                 .sentence = "A mobile crane drives past on the quay's edge, its load over the ship's deck.",
                 .frames = 340,
                 .motion = sheltered(),
                 .crane = Passage{-28.0, {1.0, 1.8, 0.6, 58.0}}});
}

void add_hurried(std::vector<Scenario>& all) {
  all.push_back(
      {.name = "fast-travel",
       .sentence =
           "The loader travels at 0.5 m/s and slews at 1.8 deg/s nearly all the time; the PLC lags 25 ms.",
       .frames = 400,
       .motion = sheltered(),
       .loader = hurried_loader_limits(),
       .gateway = {.delay = 0.0165, .jitter = 0.005}});
  all.push_back({.name = "night-shift",
                 .sentence = "Five minutes of everything: ebb, cargo, list, trim, ranging, showers, a window "
                             "wiped now and then.",
                 .frames = 3000,
                 .motion = conduct::whole_shift(),
                 .at_first = {.fill = 0.1},
                 .at_last = {.fill = 0.8},
                 .weather = rain(0.05, 0.1, 0.025, {.first = 30.0, .length = 25.0, .period = 70.0}),
                 .cover = {.when = {.first = 62.0, .length = 4.0, .period = 60.0}, .width = kWholeWindow},
                 .loader = hurried_loader_limits(),
                 .gateway = {.delay = 0.0165, .jitter = 0.005}});
}

}  // namespace

void add_view_scenarios(std::vector<Scenario>& all) {
  add_blinded(all);
  add_seen_badly(all);
  add_hurried(all);
}

}  // namespace hulltrack
