// Does the quay contradict the machine, that is its joints, mounts and latency?
//
// Each frame is judged by what the scan sees of the quay. Three frames in a row with a complaint make a
// charge (machine_charges.hpp). While any charge stands health is 0. A charge is dropped after three frames
// in a row, each of which shows that what is charged is gone, whatever wear may hide, or by a re-acquire
// edge. Three frames, because one may be wrong about the quay. A frame that sees too little of the quay
// changes nothing.
//
// Input: the filtered scan, its views, and where the machine stands. Output: MachineFinding. Frame W; metres,
// radians. Thread rule: one owner. Cost: 0.4 ms a frame, 0.7 ms while a charge stands, whatever the map's
// size.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/base/status.hpp"
#include "core/base/time.hpp"
#include "core/quay/quay_config.hpp"
#include "core/quay/quay_sight.hpp"
#include "core/witness/machine_charges.hpp"
#include "core/witness/machine_doubt.hpp"
#include "core/witness/machine_finding.hpp"
#include "core/witness/quay_search.hpp"
#include "core/witness/seen_through.hpp"
#include "core/witness/steady_motion.hpp"
#include "core/witness/top_learner.hpp"

namespace hulltrack {

class MachineWitness {
 public:
  /// The witness is the quay map, if there is one. If `map` is null it is the quay's top: as configured in
  /// `quay`, or else as the session finds it outside of `hull_W`, the box in which the hull may lie. The top
  /// needs a region, which tells quay from hull; without map and region there is no witness.
  MachineWitness(const QuayConfig& quay, std::shared_ptr<const QuayMap> map, const MachineConfig& machine,
                 const std::optional<Box>& region_W, const Box& hull_W);

  /// Whether there is a map, a known top, or a top to be found.
  [[nodiscard]] bool has_quay() const { return map_ != nullptr || top_ || learner_; }

  /// To be called once a frame. `time`: the middle of the scan; `views`: of the scan; `stand`: of the machine
  /// at that time. `on_trial`: the joints are not believed yet, so no top is learned from this frame.
  [[nodiscard]] MachineFinding look(MeasurementTime time, const FilteredScan& scan,
                                    std::span<const ScanView> views, const MachineStand& stand,
                                    bool on_trial = false);

  /// Drops all charges and all that was seen: a person has checked the joints.
  void forget();

  /// The quay's top as this session first found it; nothing if it was not found, or does not have to be.
  [[nodiscard]] std::optional<SeenTop> found_top() const {
    return learner_ ? learner_->first() : std::nullopt;
  }

  /// What the last frame saw of the quay.
  [[nodiscard]] const Misplacement& seen() const { return seen_; }

 private:
  /// The outcome of one frame.
  struct Verdict {
    bool known = false;                   // the quay was seen well enough to say something
    std::optional<MachineCharge> charge;  // the complaint; nothing: the machine is in place, if `known`
    MachineDoubt doubt;
    bool refutes_asked = false;  // the frame disproves the charge against the joint that is asked about
  };
  [[nodiscard]] const QuaySighting* sighting_of(const FilteredScan& scan, std::span<const ScanView> views,
                                                const MachineStand& stand, bool on_trial);
  [[nodiscard]] std::vector<Twist> doubt_of_reference() const;
  [[nodiscard]] Verdict judge(const MachineStand& stand) const;
  [[nodiscard]] std::optional<Verdict> judge(const MachineStand& stand,
                                             const QuaySearch::Elsewhere& elsewhere) const;
  void acquit(MeasurementTime time, const MachineStand& stand, const Verdict& verdict,
              const std::optional<WrongJoint>& asked);
  [[nodiscard]] bool is_found() const;
  [[nodiscard]] bool is_surely_found() const;
  [[nodiscard]] std::optional<MachineCharge> charge_of_lateness(const MachineStand& stand) const;
  [[nodiscard]] MachineCharge charge_by(const MachineStand& stand, const MachineDoubt& doubt,
                                        const Misplacement& seen, bool by_guess) const;
  void weigh_other_places(const MachineStand& stand, const std::optional<WrongJoint>& asked,
                          Verdict& verdict);
  void note_rest(MeasurementTime time, const Verdict& verdict);
  void forget_sight();

  std::shared_ptr<const QuayMap> map_;
  std::optional<QuayPlane> top_;
  std::optional<TopLearner> learner_;
  MachineConfig machine_;

  QuaySight sight_;
  QuaySearch search_;
  Misplacement seen_;
  std::optional<MeasurementTime> last_look_;
  SeenThrough seen_through_;
  /// What was seen when the machine last stood: lateness is measured against it.
  std::optional<Misplacement> at_rest_;
  SteadyMotion steady_;
  int charges_in_a_row_ = 0;  // frames
  MachineCharges charges_;
};

}  // namespace hulltrack
