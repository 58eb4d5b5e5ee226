// The scenarios that are about the ship: what she does, which ship it is, what shape she has.
#include <cmath>

#include "daemon/simulator/run/scenario_groups.hpp"
#include "daemon/simulator/ship/ship_conduct.hpp"

namespace hulltrack {
namespace {

using conduct::leaving;
using conduct::listing;
using conduct::loaded;
using conduct::sheltered;
using conduct::shifted;
using conduct::uneasy;
using conduct::with;

constexpr HullShape kEmpty{};
constexpr HullShape kNearlyFull{.fill = 0.95};

void add_moored(std::vector<Scenario>& all) {
  all.push_back(
      {.name = "berth",
       .sentence =
           "The paper's test: quietly moored in a sheltered river berth while loading, departs at frame 800.",
       .frames = 869,  // Guo 2025, 3.1
       .motion = with(sheltered(), {leaving(80.0, {0.8, 0.6, 0.0}, 1.5, 0.08, radians(0.3))})});
  all.push_back({.name = "static",
                 .sentence = "The hull lies still, exactly where the map was made; only the loader moves.",
                 .frames = 200,
                 .motion = {},
                 .at_first = kEmpty});
  all.push_back({.name = "mooring",
                 .sentence = "The ship ranges at its lines: surge 0.3 m, sway 0.2 m, roll half a degree.",
                 .frames = 300,
                 .motion = uneasy()});
  all.push_back(
      {.name = "loaded",
       .sentence =
           "Well into loading: 0.6 m deeper than in the map, trimmed and heeled, still sinking 1.3 m/h.",
       .frames = 150,
       .motion = loaded(),
       .at_first = {.fill = 0.8}});
  all.push_back(
      {.name = "draft",
       .sentence =
           "From light to 7 m deeper at 0.05 m/s: 4.2 m of cargo and 2.8 m of ebb, ranging at the lines.",
       .frames = 1420,
       .motion = conduct::sinking(),
       .at_first = kEmpty,
       .at_last = kNearlyFull});
  all.push_back({.name = "heel",
                 .sentence = "Listed to 3 deg off the quay, over to 3 deg towards it, and back upright.",
                 .frames = 460,
                 .motion = with(sheltered(), {listing(2.0, 12.0, {radians(3.0), 0.0, 0.0}),
                                              listing(14.0, 20.0, {radians(-6.0), 0.0, 0.0}),
                                              listing(34.0, 12.0, {radians(3.0), 0.0, 0.0})})});
  all.push_back({.name = "trim",
                 .sentence = "Trimmed by 0.9 deg down by the stern, then by the head.",
                 .frames = 300,
                 .motion = with(sheltered(), {listing(2.0, 10.0, {0.0, radians(-0.9), 0.0}),
                                              listing(13.0, 16.0, {0.0, radians(1.8), 0.0})})});
}

void add_jerked(std::vector<Scenario>& all) {
  all.push_back({.name = "surge-jerk",
                 .sentence = "A passing ship's wave: 1 m ahead within 10 s, at most at 0.2 m/s, and back.",
                 .frames = 300,
                 .motion = with(sheltered(), {shifted(5.0, {1.0, 0.0, 0.0}, 0.2, 0.04),
                                              shifted(17.0, {-1.0, 0.0, 0.0}, 0.2, 0.04)})});
  all.push_back({.name = "surge-jerk-fast",
                 .sentence = "The same within 5 s, for a second faster than 0.3 m/s, and back in 10 s.",
                 .frames = 300,
                 .motion = with(sheltered(), {shifted(8.0, {1.0, 0.0, 0.0}, 0.4, 0.16),
                                              shifted(17.0, {-1.0, 0.0, 0.0}, 0.2, 0.04)})});
  all.push_back(
      {.name = "passing-ship",
       .sentence = "A ship passes: drawn 0.8 m ahead, 0.4 m astern and 0.2 m off the quay within a minute.",
       .frames = 620,
       .motion =
           with(sheltered(),
                {shifted(4.0, {0.8, 0.0, 0.0}, 0.05, 0.01), shifted(14.0, {0.0, 0.2, 0.0}, 0.02, 0.005),
                 shifted(26.0, {-1.2, 0.0, 0.0}, 0.08, 0.01), shifted(36.0, {0.0, -0.2, 0.0}, 0.02, 0.005),
                 shifted(46.0, {0.4, 0.0, 0.0}, 0.05, 0.01)})});
  all.push_back({.name = "shift",
                 .sentence = "After 30 s the ship is warped along the quay by one hatch at 0.2 m/s.",
                 .frames = 1560,
                 .motion = with(sheltered(), {shifted(30.0, {conduct::kHatchPitch, 0.0, 0.0}, 0.2, 0.02)})});
}

void add_absent(std::vector<Scenario>& all) {
  HullMotionConfig at_sea = sheltered();
  at_sea.start_displacement = {0.0, 2000.0, 0.0};
  all.push_back({.name = "gone",
                 .sentence = "No ship at all: the mapped one is at sea.",
                 .frames = 100,
                 .motion = at_sea,
                 .mapped_ship = false});
  all.push_back({.name = "depart-astern",
                 .sentence = "Leaves astern along the quay after 6 s.",
                 .frames = 200,
                 .motion = with(sheltered(), {leaving(6.0, {-1.0, 0.0, 0.0}, 1.0, 0.05, 0.0)})});
  all.push_back({.name = "depart-sideways",
                 .sentence = "Pushed off the quay after 6 s, at 0.2 m/s at first, then faster.",
                 .frames = 260,
                 .motion = with(sheltered(), {leaving(6.0, {0.0, 1.0, 0.0}, 0.2, 0.04, 0.0),
                                              leaving(14.0, {0.1, 0.995, 0.0}, 0.8, 0.05, radians(0.2))})});
  all.push_back(
      {.name = "creep",
       .sentence = "Creeps off the quay at 0.15 m/s, slower than any alarm, until she is 3.5 m off.",
       .frames = 330,
       .motion = with(sheltered(), {shifted(5.0, {0.0, 3.5, 0.0}, 0.15, 0.05)})});
}

void add_strangers(std::vector<Scenario>& all) {
  all.push_back({.name = "wrong-ship",
                 .sentence = "Another ship of the same trade lies at the berth than the one in the map.",
                 .frames = 150,
                 .motion = sheltered(),
                 .ship_at_berth = stranger_ship(),
                 .mapped_ship = false});
  const auto add_sister = [&](std::string_view name, std::string_view sentence, const ShipDesign& ship) {
    all.push_back({.name = name,
                   .sentence = sentence,
                   .frames = 120,
                   .motion = sheltered(),
                   .ship_at_berth = ship,
                   .mapped_ship = false});
  };
  add_sister("sister-hatch", "A sister ship; her hatches lie 12 to 28 cm farther forward or aft.",
             sister_with_other_hatch_places());
  add_sister("sister-coaming", "A sister ship; her coamings are 12 to 30 cm higher or lower.",
             sister_with_other_coamings());
  add_sister("sister-width",
             "A sister ship; her hatches are 15 to 30 cm longer or shorter, wider or narrower.",
             sister_with_other_openings());
}

void add_changed(std::vector<Scenario>& all) {
  all.push_back(
      {.name = "covers",
       .sentence = "Two hatches have been closed since the map was made, two folded at the other end.",
       .frames = 150,
       .motion = sheltered(),
       .ship_at_berth = ship_with_moved_covers()});
  all.push_back({.name = "cargo",
                 .sentence = "Empty holds fill up: from a first thin layer to nearly full.",
                 .frames = 300,
                 .motion = sheltered(),
                 .at_first = kEmpty,
                 .at_last = kNearlyFull});
  const auto add_bent = [&](std::string_view name, std::string_view sentence, double bend) {
    all.push_back({.name = name,
                   .sentence = sentence,
                   .frames = 660,
                   .motion = sheltered(),
                   .at_first = {.fill = 0.35, .bend = 0.6 * bend},
                   .at_last = {.fill = 0.5, .bend = bend},
                   .loader = passing_loader_limits()});
  };
  add_bent("hog", "Bent upwards by 0.12, then 0.2 m amidships; the loader passes along the whole ship.",
           -0.2);
  add_bent("sag", "Bent downwards by 0.12, then 0.2 m amidships; the loader passes along the whole ship.",
           0.2);
}

}  // namespace

void add_ship_scenarios(std::vector<Scenario>& all) {
  add_moored(all);
  add_jerked(all);
  add_absent(all);
  add_strangers(all);
  add_changed(all);
}

}  // namespace hulltrack
