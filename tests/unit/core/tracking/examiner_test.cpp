#include "core/tracking/examiner.hpp"

#include <gtest/gtest.h>

#include "tests/support/analytic_ship.hpp"

namespace hulltrack {
namespace {

using testing::AnalyticShip;

TrackerConfig tracker_config() {
  TrackerConfig config;
  config.hull.reference_point = {3.0, -6.0, 1.4};
  config.hull.region = Box{{-40, -20, -10}, {40, 20, 20}};
  return config;
}

/// Frames of a LiDAR above a moored ship, and an examiner of them.
class Frames {
 public:
  /// `rivals`: in each frame another pose is examined as well, before and after the frame's own.
  Examination run(int frames, bool rivals) {
    const Pose elsewhere(Eigen::Translation3d(0.3, 0.0, 0.1));
    Examination last;
    for (int i = 0; i < frames; ++i) {
      const Scan scan = testing::scan_ship(&ship_, sensor_, {.frame = frame_++});
      filter_.run(scan, joints_, {}, filtered_);
      views_[0].rebuild(filtered_.returns_W[0], sensor_.mount);
      const SeenScan seen{filtered_, views_, filter_.sensors()};
      if (rivals) {
        EXPECT_GT(examiner_.report_at(elsewhere, seen).expected, 100U);
      }
      last = examiner_.examine({Pose::Identity(), tracker_config().hull.reference_point}, scan.mid_time(),
                               seen, Matrix6(1e-7 * Matrix6::Identity()), {0.0, 60.0}, {});
      if (rivals) {
        (void)examiner_.report_at(elsewhere, seen);
      }
    }
    return last;
  }

 private:
  AnalyticShip ship_ = AnalyticShip::bulk_carrier();
  SensorConfig sensor_ = testing::looking_down({-1.0, -3.0, 17.0});
  JointHistory joints_ = testing::joints_at_rest(10.0);
  ScanFilter filter_{MachineConfig{}, {sensor_}, tracker_config().hull.region};
  Examiner examiner_{tracker_config(), testing::bulk_carrier_map()};
  FilteredScan filtered_;
  std::vector<ScanView> views_ = std::vector<ScanView>(1);
  std::uint32_t frame_ = 0;
};

TEST(Examiner, ARivalsExaminationChangesNothingThatIsKnownOfTheFramesOwnPose) {
  Frames alone;
  Frames with_rivals;
  for (int i = 0; i < 15; ++i) {
    const Examination a = alone.run(1, false);
    const Examination b = with_rivals.run(1, true);
    EXPECT_EQ(a.integrity.faults, b.integrity.faults) << i;
    EXPECT_EQ(a.integrity.reason, b.integrity.reason) << i;
    EXPECT_EQ(a.integrity.undecided, b.integrity.undecided) << i;
    EXPECT_EQ(a.confirmed, b.confirmed);
    EXPECT_EQ(a.metrics.q1, b.metrics.q1);
    EXPECT_EQ(a.step.covariance_translation, b.step.covariance_translation);
    EXPECT_TRUE(i < 12 || (a.integrity.faults == 0 && !a.integrity.undecided)) << a.integrity.reason;
  }
}

}  // namespace
}  // namespace hulltrack
