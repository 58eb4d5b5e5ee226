// Does the quay contradict the machine? One frame's sight of it, and what stands since earlier ones.
//
// A machine beyond its class takes health until sights of the quay that would have shown it again show less
// than half of it, or a re-acquire edge comes. One frame may be wrong about the quay, three in a row are not;
// a frame that sees none of it changes nothing. Frames as in the parts that it calls. Thread rule: one owner.
// Cost: 0.4 ms a frame, 0.7 ms while a charge stands, whatever the map's size.
#pragma once

#include <deque>
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
#include "core/witness/top_learner.hpp"

namespace hulltrack {

class MachineWitness {
 public:
  /// `map` may be null: then the quay's top is the witness, if there is a region to tell quay from hull: as
  /// `quay` knows it, or as it is found beside `hull_W`, where the hull may lie.
  MachineWitness(const QuayConfig& quay, std::shared_ptr<const QuayMap> map, const MachineConfig& machine,
                 const std::optional<Box>& region_W, const Box& hull_W);

  /// Whether there is anything that it could see.
  [[nodiscard]] bool has_quay() const { return map_ != nullptr || top_ || learner_; }

  /// Once a frame, of which `time` is the middle. `views` of the scan, `stand` at its middle.
  /// `on_trial`: the joints are not believed yet, so nothing is learned by them.
  [[nodiscard]] MachineFinding look(MeasurementTime time, const FilteredScan& scan,
                                    std::span<const ScanView> views, const MachineStand& stand,
                                    bool on_trial = false);

  /// A person has checked the joints.
  void forget();

  /// Where this session saw the quay's top that nobody has measured; nothing where it need not be found.
  [[nodiscard]] std::optional<SeenTop> found_top() const {
    return learner_ ? learner_->first() : std::nullopt;
  }

  /// What the last frame saw of the quay.
  [[nodiscard]] const Misplacement& seen() const { return seen_; }

 private:
  /// What one frame comes to: nothing known, or in place (no charge), or elsewhere.
  struct Verdict {
    bool known = false;
    std::optional<MachineCharge> charge;
    MachineDoubt doubt;
    bool refutes_asked = false;  // the joint's charge that was held against it
  };
  [[nodiscard]] const QuaySighting* sighting_of(const FilteredScan& scan, std::span<const ScanView> views,
                                                const MachineStand& stand, bool on_trial);
  [[nodiscard]] std::vector<Twist> doubt_of_reference() const;
  [[nodiscard]] Verdict judge(const MachineStand& stand) const;
  [[nodiscard]] std::optional<Verdict> judge(const MachineStand& stand,
                                             const QuaySearch::Elsewhere& elsewhere) const;
  void acquit(const MachineStand& stand, const Verdict& verdict, const std::optional<WrongJoint>& asked);
  [[nodiscard]] std::optional<MachineCharge> charge_of_lateness(const MachineStand& stand) const;
  [[nodiscard]] MachineCharge charge_by(const MachineStand& stand, const MachineDoubt& doubt,
                                        const Misplacement& seen) const;
  void weigh_other_places(const MachineStand& stand, const std::optional<WrongJoint>& asked,
                          Verdict& verdict);
  void note_rest(MeasurementTime time, const MachineStand& stand, const Verdict& verdict);
  void remember(const QuaySighting& sighting);
  void forget_sight();
  [[nodiscard]] std::string seen_through() const;

  std::shared_ptr<const QuayMap> map_;
  std::optional<QuayPlane> top_;
  std::optional<TopLearner> learner_;
  MachineConfig machine_;

  QuaySight sight_;
  QuaySearch search_;
  Misplacement seen_;
  std::optional<MeasurementTime> last_look_;
  struct Memory {  // of the last frames, fading
    double reached = 0.0;
    double seen_through = 0.0;
    std::deque<Point> where_W;  // of the last ones that were seen through
  };
  std::array<Memory, QuayMap::kClasses> planes_;
  /// The quay as it was seen when the machine stood last.
  std::optional<MeasurementTime> standing_since_;
  std::optional<Misplacement> at_rest_;
  int charges_in_a_row_ = 0;
  int clean_in_a_row_ = 0;
  MachineCharges charges_;
};

}  // namespace hulltrack
