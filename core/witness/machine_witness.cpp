#include "core/witness/machine_witness.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/text.hpp"
#include "core/registration/plane_system.hpp"
#include "core/witness/refutation.hpp"

namespace hulltrack {
namespace {

// The quay is found if this share of the observations agree with one misplacement. Most agree if the returns
// are the quay's. A sixth agree by chance if nothing is in its place: offsets are then spread over the gate
// of 0.6 m, and 10 cm agree. The limit is between the two, three sigma off either at 60 returns.
constexpr double kLeastShare = 0.5;
constexpr std::uint32_t kFewestObservations = 60;
constexpr std::uint32_t kFewestAsked = kFewestObservations / QuayObserver::kFrames;  // a frame
// The quay is surely found if this share agree; the rest may be returns of lorries and people.
constexpr double kSureShare = 0.8;

// The slope of a top that the session has found may be wrong by so many of its sigmas.
constexpr double kSigmasOfTop = 3.0;
constexpr const char* kSinceFound = "against where this session found the quay's top, ";

std::optional<QuayPlane> known_top(const QuayConfig& quay) {
  return quay.height && quay.slope ? std::optional(QuayPlane{*quay.height, *quay.slope}) : std::nullopt;
}

}  // namespace

MachineWitness::MachineWitness(const QuayConfig& quay, std::shared_ptr<const QuayMap> map,
                               const MachineConfig& machine, const std::optional<Box>& region_W,
                               const Box& hull_W)
    : map_(std::move(map)), machine_(machine), sight_(region_W.has_value()) {
  if (map_ == nullptr && region_W && quay.top_is_witness) {
    top_ = known_top(quay);
    if (!top_) {
      learner_.emplace(hull_W, machine.slew.translation().y());
    }
  }
}

MachineFinding MachineWitness::look(MeasurementTime time, const FilteredScan& scan,
                                    std::span<const ScanView> views, const MachineStand& stand,
                                    bool on_trial) {
  if (!has_quay()) {
    return {};
  }
  if (last_look_ && time - *last_look_ > JointHistory::kMaxGap) {
    forget_sight();  // the joints may be wrong in another way by now
  }
  last_look_ = time;
  const QuaySighting* sighting = sighting_of(scan, views, stand, on_trial);
  if (sighting == nullptr) {
    return {};
  }
  seen_through_.remember(*sighting);
  seen_ = find_misplacement(sighting->observed->all);
  Verdict verdict = judge(stand);
  bool confirmed = false;
  const std::optional<WrongJoint> asked = charges_.next_joint();
  if (map_ != nullptr) {
    search_.see(*map_, sight_.returns_W(), *sighting->observed, machine_, stand, charges_.any());
    weigh_other_places(stand, asked, verdict);
    confirmed = verdict.known && !verdict.charge && seen_.holds_all();
    for (const JointName joint : kAllJoints) {
      const bool finds_large = search_.would_find(joint);
      verdict.doubt.joints.at(static_cast<std::size_t>(joint)).finds_large = finds_large;
      confirmed = confirmed && finds_large;
    }
  }
  steady_.note(time, stand);
  note_rest(time, verdict);
  if (verdict.known && verdict.charge) {
    charges_.refute_none();
    if (++charges_in_a_row_ >= MachineCharges::kNeeded) {
      charges_.add(*verdict.charge);
    }
  } else if (verdict.known) {
    charges_in_a_row_ = 0;
    acquit(time, stand, verdict, asked);
  } else if (asked) {
    charges_.hear(asked->joint, false);
  }
  return {charges_.any() ? fault::plc_value : Faults{0}, charges_.reason(), confirmed, verdict.doubt.joints};
}

/// What the frame shows of the map or the top. Null while the session has not found a top yet; then the frame
/// is used to find it.
const QuaySighting* MachineWitness::sighting_of(const FilteredScan& scan, std::span<const ScanView> views,
                                                const MachineStand& stand, bool on_trial) {
  if (map_ != nullptr) {
    return &sight_.look_for(*map_, scan, views, is_found() ? seen_.pose() : Pose::Identity());
  }
  if (top_) {
    return &sight_.look_for(*top_, scan);
  }
  if (const auto& top = learner_->top()) {
    const QuaySighting& sighting = sight_.look_for(top->seen.plane, scan, &top->seen.area_W);
    // A top is given up when its place is long out of view, but not while a charge stands, which was made
    // against this top. Returns at its place count as view of it, on the plane or not.
    learner_->seen(charges_.any() || sighting.asked >= kFewestAsked);
    return &sighting;
  }
  if (on_trial) {
    learner_->drop_gathered();
  } else {
    learner_->add(sight_.returns_of(scan), stand);
  }
  return nullptr;
}

/// Errors that a top found by this session may have, as twists: all wear that the machine may have had then,
/// and the uncertainty of its slope. Empty for a map or a configured top.
std::vector<Twist> MachineWitness::doubt_of_reference() const {
  if (!learner_ || !learner_->top()) {
    return {};
  }
  const TopLearner::Top& top = *learner_->top();
  std::vector<Twist> twists = wear_twists(machine_, top.stand, seen_.centre_W);
  for (int i = 0; i < 2; ++i) {
    Twist tilt = Twist::Zero();
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(i);
    tilt << axis, axis.cross(seen_.centre_W - top.seen.middle_W);
    twists.push_back(kSigmasOfTop * top.seen.sigma_slope * tilt);
  }
  return twists;
}

MachineWitness::Verdict MachineWitness::judge(const MachineStand& stand) const {
  Verdict verdict;
  const bool found = is_found();
  if (found) {
    verdict.doubt = doubt_machine(machine_, stand, seen_, doubt_of_reference());
  }
  // If the quay is surely found in its place on all six axes, planes that are seen through have been removed.
  const bool surely_in_place = found && !verdict.doubt.beyond_class && seen_.holds_all() && is_surely_found();
  std::string through = surely_in_place ? std::string{} : seen_through_.complaint();
  verdict.known = found || !through.empty();
  if (!through.empty()) {
    verdict.charge = MachineCharge{std::move(through), WrongAltogether{}};
  } else if (found && verdict.doubt.beyond_class) {
    verdict.charge = charge_by(stand, verdict.doubt, seen_, false);
  } else if (found) {
    verdict.charge = charge_of_lateness(stand);
  }
  return verdict;
}

/// The charge of late joint values, if there is one. They misplace the quay only while the machine moves, so
/// what is seen now is compared with what was seen at rest.
std::optional<MachineCharge> MachineWitness::charge_of_lateness(const MachineStand& stand) const {
  if (!at_rest_ || !seen_.holds_all()) {
    return std::nullopt;
  }
  const JointDoubt late = doubt_latency(machine_, stand, seen_, *at_rest_);
  if (!(std::abs(late.reads_too_much) > late.hidden)) {
    return std::nullopt;
  }
  return MachineCharge{
      format_text("the quay moves with the machine as if joint values were %.0f ms %s than plc.latency_ms "
                  "says",
                  1e3 * std::abs(late.reads_too_much), late.reads_too_much > 0.0 ? "older" : "younger"),
      WrongLatency{late.reads_too_much, rate_of(stand)}};
}

MachineCharge MachineWitness::charge_by(const MachineStand& stand, const MachineDoubt& doubt,
                                        const Misplacement& seen, bool by_guess) const {
  std::string reason = (learner_ ? kSinceFound : "") + describe(doubt, seen);
  if (doubt.accused) {
    const JointDoubt& accused = doubt.joints.at(static_cast<std::size_t>(*doubt.accused));
    return {std::move(reason), WrongJoint{*doubt.accused, accused.reads_too_much}};
  }
  const double moves = PlaneSystem::kLever * seen.twist.head<3>().norm() + seen.twist.tail<3>().norm();
  WrongPlace place{stand, seen.about(stand.sensor_W), seen.unheld(),
                   by_guess && moves > QuaySearch::kWithinGate};
  for (Twist& twist : place.unheld) {
    twist = about_point(stand.sensor_W - seen.centre_W, twist);
  }
  return {std::move(reason), std::move(place)};
}

/// Lets two other places of the machine change the frame's verdict. The place that the charge against joint
/// `asked` gives decides if it explains the scan no worse than the machine's own values do. The place of the
/// better guess decides if its surplus is larger, or if the charge's place does not decide.
void MachineWitness::weigh_other_places(const MachineStand& stand, const std::optional<WrongJoint>& asked,
                                        Verdict& verdict) {
  const auto elsewhere = search_.look(*map_, machine_);
  std::optional<Verdict> of_elsewhere = elsewhere ? judge(stand, *elsewhere) : std::nullopt;
  if (asked) {
    const MachineGuess charged{.joint = asked->joint, .amount = asked->amount};
    const QuaySearch::There there = search_.look_there(*map_, twist_of(charged, machine_, stand));
    // That the charged amount is wrong clears the joint only if another amount would have been found.
    verdict.refutes_asked = there.refuted && search_.would_find(asked->joint);
    if (of_elsewhere && elsewhere->surplus > there.surplus) {
      verdict = std::move(*of_elsewhere);
      return;
    }
    const MachineDoubt doubt = doubt_machine(machine_, stand, there.seen);
    if (doubt.beyond_class) {
      verdict = {.known = true, .charge = charge_by(stand, doubt, there.seen, true), .doubt = doubt};
      return;
    }
    // The charge is neither confirmed nor refuted: the frame counts only if it shows another error.
    if (!there.worse &&
        doubt.joints.at(static_cast<std::size_t>(asked->joint)).hidden >= std::abs(asked->amount)) {
      verdict.known = verdict.charge.has_value();
      return;
    }
  }
  if (of_elsewhere) {
    verdict = std::move(*of_elsewhere);
  }
}

/// The charge that a better guess leads to, if any. Either the planes there show an error beyond wear. Or
/// they tell nothing of the joint and the guess has lasted: then the guess itself is charged.
std::optional<MachineWitness::Verdict> MachineWitness::judge(const MachineStand& stand,
                                                             const QuaySearch::Elsewhere& elsewhere) const {
  const MachineDoubt doubt = doubt_machine(machine_, stand, elsewhere.seen);
  if (doubt.beyond_class) {
    return Verdict{.known = true, .charge = charge_by(stand, doubt, elsewhere.seen, true), .doubt = doubt};
  }
  const MachineGuess& guess = elsewhere.guess;
  if (elsewhere.lasting && guess.joint && guess.beyond_wear &&
      doubt.joints.at(static_cast<std::size_t>(*guess.joint)).hidden >= std::abs(guess.amount)) {
    MachineCharge charge{accusation(*guess.joint, guess.amount), WrongJoint{*guess.joint, guess.amount}};
    return Verdict{.known = true, .charge = std::move(charge), .doubt = doubt};
  }
  return std::nullopt;
}

/// Keeps what is seen as the sight at rest, if the machine has stood for long enough, the frame has no
/// complaint and all six directions are held.
void MachineWitness::note_rest(MeasurementTime time, const Verdict& verdict) {
  const bool at_rest = steady_.is_settled(time) && steady_.stands();
  if (at_rest && verdict.known && !verdict.charge && seen_.holds_all()) {
    at_rest_ = seen_;
  }
}

/// Tells each charge whether this frame, in which the quay is in place, refutes it; of the joints' charges
/// only `asked`. A frame in which wear could explain the amount refutes nothing, nor do offsets one that is
/// too large to show as such.
void MachineWitness::acquit(MeasurementTime time, const MachineStand& stand, const Verdict& verdict,
                            const std::optional<WrongJoint>& asked) {
  if (asked) {
    const JointDoubt& left = verdict.doubt.joints.at(static_cast<std::size_t>(asked->joint));
    const bool in_reach = map_ == nullptr || search_.shows_as_offset(asked->joint, asked->amount);
    charges_.hear(asked->joint, verdict.refutes_asked || (in_reach && refutes(left, asked->amount)));
  }
  if (const auto latency = charges_.charged<WrongLatency>()) {
    const bool comparable = at_rest_ && seen_.holds_all() && steady_.is_settled(time);
    charges_.hear<WrongLatency>(comparable && refutes(*latency, {machine_, stand, seen_}, *at_rest_));
  }
  if (const auto place = charges_.charged<WrongPlace>()) {
    charges_.hear<WrongPlace>(
        refutes(*place, {machine_, stand, seen_}, doubt_of_reference(),
                [this](const Twist& off) { return search_.look_there(*map_, off).refuted; }));
  }
  charges_.hear<WrongAltogether>(seen_.holds_all() && is_surely_found());
}

bool MachineWitness::is_found() const {
  const bool few = seen_.observations < kFewestObservations || seen_.measured.empty();
  return !few && double(seen_.agreeing) >= kLeastShare * double(seen_.observations);
}

/// Most observations agree: hardly any of them can be of something else than the quay.
bool MachineWitness::is_surely_found() const {
  return double(seen_.agreeing) >= kSureShare * double(seen_.observations);
}

void MachineWitness::forget_sight() {
  seen_ = {};
  steady_ = {};
  at_rest_.reset();
  sight_.forget();
  search_.forget();
  if (learner_) {
    learner_->drop_gathered();
  }
  seen_through_ = {};
  charges_in_a_row_ = 0;
  charges_.refute_none();
}

void MachineWitness::forget() {
  forget_sight();
  charges_.drop_all();
  if (learner_) {
    learner_->forget();
  }
}

}  // namespace hulltrack
