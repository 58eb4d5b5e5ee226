#include "core/witness/machine_witness.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/quay_scene.hpp"

namespace hulltrack {
namespace {

using std::chrono::milliseconds;
using testing::misplaced;
using testing::quay_cloud;
using testing::quay_frame;
using testing::quay_machine;
using testing::QuayFrame;
using testing::QuaySurface;

const Joints kWorking{0.0, radians(80.0), radians(-2.0)};
const Box kHull{{-95.0F, 1.0F, -8.0F}, {95.0F, 33.0F, 20.0F}};
const Box kRegion{{-95.0F, 0.6F, -10.0F}, {95.0F, 45.0F, 25.0F}};

const std::vector<std::size_t> kAllSurfaces = {0, 1, 2, 3};

std::shared_ptr<const QuayMap> whole_map() {
  static const auto map = std::make_shared<const QuayMap>(quay_cloud({0, 1, 2, 3, 5, 6}));
  return map;
}

std::shared_ptr<const QuayMap> quay_map() {
  static const auto map = std::make_shared<const QuayMap>(quay_cloud());
  return map;
}

/// Frames at 10 Hz of a machine whose joints read something else than they should.
class Frames {
 public:
  explicit Frames(std::shared_ptr<const QuayMap> map = quay_map(), const QuayConfig& quay = {},
                  int returns_of_each_surface = 400)
      : witness_(quay, std::move(map), quay_machine(), kRegion, kHull), count_(returns_of_each_surface) {}

  MachineFinding run(int frames, const Joints& too_much, const std::vector<std::size_t>& surfaces = {0, 1, 2},
                     const Joints& rate = {}) {
    MachineFinding finding;
    for (int i = 0; i < frames; ++i) {
      const Joints reported{kWorking.d_x + too_much.d_x, kWorking.theta_r + too_much.theta_r,
                            kWorking.theta_p + too_much.theta_p};
      QuayFrame frame = quay_frame(reported, misplaced(reported, kWorking), static_cast<unsigned>(frame_),
                                   count_, surfaces, besides_);
      frame.stand.rate = rate;
      finding =
          witness_.look(MeasurementTime{milliseconds(100) * frame_++}, frame.scan, frame.views, frame.stand);
    }
    return finding;
  }
  MachineWitness& witness() { return witness_; }
  /// So many frames are not seen.
  void pass(int frames) { frame_ += frames; }
  /// What is in no map stands on the quay from now on.
  void show(const QuaySurface& surface) { besides_.push_back(surface); }

 private:
  std::vector<QuaySurface> besides_;
  MachineWitness witness_;
  int count_;
  int frame_ = 0;
};

TEST(MachineWitness, AQuayInItsPlaceConfirmsAllSixAxes) {
  Frames frames(whole_map());
  for (int i = 0; i < 30; ++i) {
    const MachineFinding finding = frames.run(1, {}, kAllSurfaces);
    EXPECT_EQ(finding.faults, 0) << finding.reason;
    EXPECT_TRUE(i < 18 || finding.confirmed)
        << i << finding.joints[0].finds_large << finding.joints[1].finds_large
        << finding.joints[2].finds_large;
  }
}

TEST(MachineWitness, AWallThatMightHaveBeenMovedConfirmsNothingNorWouldItShowALargeError) {
  // 15 m of it across the rails, no longer than what leaves in one piece.
  Frames frames(std::make_shared<const QuayMap>(quay_cloud({0, 1, 2, 5, 6})));
  for (int i = 0; i < 30; ++i) {
    const MachineFinding finding = frames.run(1, {});
    EXPECT_FALSE(finding.confirmed);
    EXPECT_FALSE(finding.joints[0].finds_large);
    EXPECT_TRUE(i < 18 || finding.joints[2].finds_large) << "the top is long enough for the luff";
  }
}

TEST(MachineWitness, AJointBeyondItsClassTakesHealthWithinHalfASecond) {
  const std::vector<std::pair<Joints, const char*>> cases = {{{0.25, 0.0, 0.0}, "travel"},
                                                             {{-0.25, 0.0, 0.0}, "travel"},
                                                             {{0.0, radians(0.7), 0.0}, "slew"},
                                                             {{0.0, 0.0, radians(-1.2)}, "luff"}};
  for (const auto& [too_much, joint] : cases) {
    Frames frames;
    frames.run(10, {});
    EXPECT_EQ(frames.run(1, too_much).faults, 0) << "one frame may be wrong";
    const MachineFinding finding = frames.run(14, too_much);
    EXPECT_EQ(finding.faults, fault::plc_value) << joint;
    EXPECT_NE(finding.reason.find(joint), std::string::npos) << finding.reason;
    EXPECT_FALSE(finding.confirmed);
  }
}

TEST(MachineWitness, AMachineThatIsMetresOffSeesThroughTheQuaysWalls) {
  // More than one thing that could have left.
  Frames frames(whole_map());
  const MachineFinding finding = frames.run(20, {7.0, 0.0, 0.0}, kAllSurfaces);
  EXPECT_EQ(finding.faults, fault::plc_value);
  EXPECT_NE(finding.reason.find("transverse"), std::string::npos) << finding.reason;
}

TEST(MachineWitness, WhatEarlierFramesSawThroughAccusesNobodyWhileNothingIsSeen) {
  Frames frames(whole_map());
  EXPECT_EQ(frames.run(2, {7.0, 0.0, 0.0}, kAllSurfaces).faults, 0) << "two may be wrong";
  EXPECT_EQ(frames.run(30, {7.0, 0.0, 0.0}, {}).faults, 0) << "a LiDAR that is blind";
  EXPECT_EQ(frames.run(3, {7.0, 0.0, 0.0}, kAllSurfaces).faults, fault::plc_value);
}

TEST(MachineWitness, AJointThatIsOffByMoreThanAGateIsFoundWhereTheQuayIsMet) {
  // So far to this side no ray goes through a wall, and none of its returns is near it.
  const std::vector<std::pair<Joints, const char*>> cases = {{{-1.3, 0.0, 0.0}, "travel read 1.3"},
                                                             {{-4.8, 0.0, 0.0}, "travel read 4."},
                                                             {{0.0, radians(-2.2), 0.0}, "slew read 2."},
                                                             {{0.0, 0.0, radians(2.5)}, "luff read 2."}};
  for (const auto& [too_much, words] : cases) {
    Frames frames(whole_map());
    const MachineFinding finding = frames.run(30, too_much, kAllSurfaces);
    EXPECT_EQ(finding.faults, fault::plc_value) << words;
    EXPECT_NE(finding.reason.find(words), std::string::npos) << words << ": " << finding.reason;
    EXPECT_FALSE(finding.confirmed);
    EXPECT_EQ(frames.run(20, {}, kAllSurfaces).faults, 0) << words << ": it is right again";
  }
}

TEST(MachineWitness, AJointTooFarOffForOffsetsIsNotAcquittedByWhatHappensToStandAtThePlaceOfAWall) {
  Frames frames(whole_map());
  ASSERT_NE(frames.run(30, {-3.0, 0.0, 0.0}, kAllSurfaces).faults, 0);
  // As long as a trailer, 3 m beside a wall of the map: such a machine sees it in the wall's place.
  frames.show({{17.0F, -19.0F, 1.0F}, {0.0F, 15.0F, 0.0F}, {0.0F, 0.0F, 4.0F}});
  EXPECT_NE(frames.run(40, {-3.0, 0.0, 0.0}, {0, 2}).faults, 0);
}

TEST(MachineWitness, AShedsEndThatIsTallerThanAnyVehicleShowsALargeError) {
  const std::vector<std::size_t> with_shed = {0, 2, 4};  // 6 m of it across the rails
  const auto map = std::make_shared<const QuayMap>(quay_cloud({0, 2, 4, 5}));
  EXPECT_TRUE(Frames(map).run(20, {}, with_shed).joints[0].finds_large);
  for (const double off : {-1.2, 1.2, 3.1}) {
    Frames frames(map);
    const MachineFinding finding = frames.run(30, {off, 0.0, 0.0}, with_shed);
    EXPECT_EQ(finding.faults, fault::plc_value) << off;
    EXPECT_NE(finding.reason.find("travel"), std::string::npos) << off << ": " << finding.reason;
    EXPECT_EQ(frames.run(20, {}, with_shed).faults, 0) << off;
  }
}

TEST(MachineWitness, AnErrorThatGrowsBeyondTheGateStaysCharged) {
  Frames frames(whole_map());
  for (int i = 0; i < 150; ++i) {
    const MachineFinding finding = frames.run(1, {-0.02 * i, 0.0, 0.0}, kAllSurfaces);
    EXPECT_TRUE(i < 20 || finding.faults == fault::plc_value) << "off by " << 0.02 * i << " m";
  }
}

TEST(MachineWitness, ALorryBeforeAWallIsNoOtherPlaceOfTheMachine) {
  Frames frames(whole_map());
  frames.show({{13.0F, -16.0F, 0.5F}, {0.0F, 2.5F, 0.0F}, {0.0F, 0.0F, 3.5F}});   // its back
  frames.show({{-7.0F, -18.6F, 0.5F}, {18.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 4.0F}});  // and another one's side
  for (int i = 0; i < 60; ++i) {
    const MachineFinding finding = frames.run(1, {}, {0});
    EXPECT_EQ(finding.faults, 0) << finding.reason;
  }
}

TEST(MachineWitness, ALorryThatHasLeftTheQuayIsNoFaultOfTheMachine) {
  // A wall of the map is gone: every ray goes through it.
  Cloud with_lorry = quay_cloud();
  for (float y = -18.0F; y < -1.0F; y += 0.1F) {
    for (float z = 1.0F; z < 9.0F; z += 0.1F) {
      with_lorry.emplace_back(-8.0F, y, z);
    }
  }
  Frames frames(std::make_shared<const QuayMap>(with_lorry), {}, 5000);
  for (int i = 0; i < 40; ++i) {
    const MachineFinding finding = frames.run(1, {});
    EXPECT_EQ(finding.faults, 0) << finding.reason;
  }
}

TEST(MachineWitness, SaysOfEachJointHowMuchItHides) {
  Frames frames(whole_map());
  const MachineFinding finding = frames.run(20, {0.3, 0.0, 0.0}, kAllSurfaces);
  EXPECT_NEAR(finding.joints[0].reads_too_much, 0.3, 0.05);
  EXPECT_GT(finding.joints[0].hidden, 0.05);
  EXPECT_LT(finding.joints[0].hidden, 0.2);
  EXPECT_TRUE(std::isinf(Frames().run(5, {}, {}).joints[0].hidden)) << "of no quay nothing is known";
}

TEST(MachineWitness, AChargeStandsUntilASightThatWouldHaveShownItDoesNot) {
  Frames frames;
  frames.run(20, {0.3, 0.0, 0.0});
  EXPECT_NE(frames.run(20, {0.3, 0.0, 0.0}, {0}).faults, 0) << "of the top alone nobody sees a wrong travel";
  EXPECT_EQ(frames.run(20, {}).faults, 0);
}

TEST(MachineWitness, AnAcquittalNeedsAsManySightsAsACharge) {
  Frames frames;
  frames.run(20, {0.3, 0.0, 0.0});
  frames.pass(10);  // what was seen is forgotten, what was charged is not
  EXPECT_NE(frames.run(1, {}).faults, 0) << "one frame may be wrong";
  EXPECT_NE(frames.run(1, {}).faults, 0);
  EXPECT_EQ(frames.run(1, {}).faults, 0);
}

TEST(MachineWitness, SightsThatWouldNotHaveShownItDoNotCountForAnAcquittal) {
  Frames frames;
  frames.run(20, {0.3, 0.0, 0.0});
  EXPECT_NE(frames.run(30, {}, {0}).faults, 0) << "of the top alone nobody sees a wrong travel";
  EXPECT_NE(frames.run(2, {}).faults, 0) << "two may be wrong";
  EXPECT_EQ(frames.run(8, {}).faults, 0);
}

TEST(MachineWitness, AJointIsNotAcquittedBecauseAnotherOneIsCharged) {
  Frames frames;
  frames.run(20, {0.3, 0.0, 0.0});
  // Of the top alone a luff is seen, and seen to be right again; of the travel nothing is.
  EXPECT_NE(frames.run(20, {0.3, 0.0, radians(1.2)}, {0}).reason.find("luff"), std::string::npos);
  const MachineFinding finding = frames.run(20, {0.3, 0.0, 0.0}, {0});
  EXPECT_EQ(finding.faults, fault::plc_value);
  EXPECT_NE(finding.reason.find("travel"), std::string::npos) << finding.reason;
}

TEST(MachineWitness, AReacquireEdgeForgetsButSwitchesNothingOff) {
  Frames frames;
  frames.run(20, {0.3, 0.0, 0.0});
  frames.witness().forget();
  EXPECT_EQ(frames.run(1, {0.3, 0.0, 0.0}).faults, 0);
  EXPECT_NE(frames.run(10, {0.3, 0.0, 0.0}).faults, 0);
}

TEST(MachineWitness, JointValuesThatComeLateShowWhileTheMachineTravels) {
  const Joints travelling{0.4, 0.0, 0.0};
  const auto late_by = [](double seconds) { return Joints{-0.4 * seconds, 0.0, 0.0}; };
  Frames honest;
  honest.run(20, {});
  EXPECT_EQ(honest.run(40, late_by(0.01), {0, 1, 2}, travelling).faults, 0) << "within the class";
  Frames frames;
  frames.run(20, {});
  const MachineFinding finding = frames.run(20, late_by(0.25), {0, 1, 2}, travelling);
  EXPECT_EQ(finding.faults, fault::plc_value);
  EXPECT_NE(finding.reason.find("older than plc.latency_ms"), std::string::npos) << finding.reason;
  EXPECT_NE(frames.run(20, {}).faults, 0) << "at rest nobody sees how late they are";
  EXPECT_NE(frames.run(25, {}, {0, 1, 2}, {0.0, radians(2.0), 0.0}).faults, 0) << "those of another joint";
  EXPECT_NE(frames.run(20, {}).faults, 0);
  for (int i = 0; i < 12; ++i) {
    EXPECT_NE(frames.run(1, late_by(0.25), {0, 1, 2}, travelling).faults, 0)
        << "most of what is seen is of the rest";
  }
  EXPECT_EQ(frames.run(20, late_by(0.01), {0, 1, 2}, travelling).faults, 0) << "they are in time again";
}

TEST(MachineWitness, AScanWithoutTheQuayChangesNothing) {
  Frames frames;
  frames.run(20, {0.3, 0.0, 0.0});
  EXPECT_NE(frames.run(30, {}, {}).faults, 0);
  Frames honest;
  const MachineFinding finding = honest.run(30, {}, {});
  EXPECT_EQ(finding.faults, 0);
  EXPECT_FALSE(finding.confirmed);
}

TEST(MachineWitness, TheTopAloneShowsLuffAndConfirmsNothing) {
  QuayConfig quay;
  quay.height = 0.0;
  quay.slope = Eigen::Vector2d::Zero();
  Frames frames(nullptr, quay);
  const MachineFinding honest = frames.run(20, {});
  EXPECT_EQ(honest.faults, 0) << honest.reason;
  EXPECT_FALSE(honest.confirmed);
  EXPECT_EQ(frames.run(20, {0.0, 0.0, radians(1.5)}).faults, fault::plc_value);
  Frames travelling(nullptr, quay);
  EXPECT_EQ(travelling.run(20, {3.0, 0.0, 0.0}).faults, 0)
      << "a plane looks the same everywhere along itself";
}

const std::vector<std::size_t> kMostlyTop = {0, 0, 1};

TEST(MachineWitness, ATopThatIsFoundShowsWhatHasChangedSinceAndConfirmsNothing) {
  Frames frames(nullptr);
  EXPECT_TRUE(frames.witness().has_quay());
  EXPECT_FALSE(frames.witness().found_top());
  const MachineFinding honest = frames.run(60, {}, kMostlyTop);
  EXPECT_EQ(honest.faults, 0) << honest.reason;
  EXPECT_FALSE(honest.confirmed);
  ASSERT_TRUE(frames.witness().found_top());
  EXPECT_NEAR(frames.witness().found_top()->plane.height, 0.0, 0.02);
  const MachineFinding finding = frames.run(20, {0.0, 0.0, radians(2.0)}, kMostlyTop);
  EXPECT_EQ(finding.faults, fault::plc_value);
  EXPECT_NE(finding.reason.find("found the quay's top"), std::string::npos) << finding.reason;
  EXPECT_EQ(frames.run(20, {}, kMostlyTop).faults, 0) << "it is where it was again";
}

TEST(MachineWitness, ATopThatAWornMachineHasFoundAccusesNoWornMachine) {
  Frames frames(nullptr);
  frames.run(30, {0.03, radians(0.15), radians(0.15)}, kMostlyTop);
  EXPECT_TRUE(frames.witness().found_top());
  const MachineFinding finding = frames.run(60, {-0.03, radians(-0.15), radians(-0.15)}, kMostlyTop);
  EXPECT_EQ(finding.faults, 0) << finding.reason;
}

TEST(MachineWitness, WhatNoJointExplainsIsAcquittedByTheTopThatShowedIt) {
  QuayConfig quay;
  quay.height = 0.0;
  quay.slope = Eigen::Vector2d::Zero();
  MachineWitness witness(quay, nullptr, quay_machine(), kRegion, kHull);
  MachineFinding finding;
  const auto run = [&](const Pose& E, int from) {
    for (int i = from; i < from + 20; ++i) {
      const QuayFrame frame = quay_frame(kWorking, E, static_cast<unsigned>(i), 400, {0});
      finding = witness.look(MeasurementTime{milliseconds(100) * i}, frame.scan, frame.views, frame.stand);
    }
  };
  run(Pose(Eigen::Translation3d(0.0, 0.0, 0.5)), 0);
  EXPECT_EQ(finding.faults, fault::plc_value);
  run(Pose::Identity(), 20);
  EXPECT_EQ(finding.faults, 0) << finding.reason;
}

TEST(MachineWitness, NothingIsAcquittedBecauseElsewhereWearCouldExplainIt) {
  MachineWitness witness({}, quay_map(), quay_machine(), kRegion, kHull);
  MachineFinding finding;
  int number = 0;
  const auto run = [&](double sensor_too_high, const Joints& joints) {
    const Pose E(Eigen::Translation3d(0.0, 0.0, sensor_too_high));
    for (const int end = number + 20; number < end; ++number) {
      const QuayFrame frame = quay_frame(joints, E, static_cast<unsigned>(number));
      finding =
          witness.look(MeasurementTime{milliseconds(100) * number}, frame.scan, frame.views, frame.stand);
    }
  };
  const Joints near{-40.0, radians(80.0), radians(-2.0)};
  const Joints far{-40.0, radians(150.0), radians(-2.0)};  // of the quay, so that wear hides more of a height
  run(-0.325, far);
  ASSERT_EQ(finding.faults, 0) << "else this shows nothing: " << finding.reason;
  run(-0.325, near);
  EXPECT_EQ(finding.faults, fault::plc_value);
  run(-0.325, far);
  EXPECT_EQ(finding.faults, fault::plc_value) << "it is as low as before";
  run(0.0, near);
  EXPECT_EQ(finding.faults, 0) << finding.reason;
}

TEST(MachineWitness, AMountTooFarOffForOffsetsIsNotAcquittedByWhatHappensToLieAtThePlaceOfTheQuay) {
  MachineWitness witness({}, whole_map(), quay_machine(), kRegion, kHull);
  MachineFinding finding;
  int number = 0;
  const auto run = [&](const Pose& E, const std::vector<QuaySurface>& besides = {}) {
    for (const int end = number + 30; number < end; ++number) {
      const QuayFrame frame = quay_frame(kWorking, E, static_cast<unsigned>(number), 400, {0}, besides);
      finding =
          witness.look(MeasurementTime{milliseconds(100) * number}, frame.scan, frame.views, frame.stand);
    }
  };
  const Pose turned = pose_about(testing::stand_at(kWorking).sensor_W, so3_exp({0.0, radians(3.0), 0.0}),
                                 Eigen::Vector3d::Zero());
  run(turned);
  ASSERT_EQ(finding.faults, fault::plc_value);
  EXPECT_NE(finding.reason.find("a mount"), std::string::npos) << finding.reason;
  // A heap that looks level and where the top should be, as large as the part of the top that is seen.
  const Eigen::Isometry3f back(turned.inverse().cast<float>());
  const QuaySurface& top = testing::quay_surfaces().front();
  run(turned, {{back * top.corner, back.linear() * top.u, back.linear() * top.v}});
  EXPECT_EQ(finding.faults, fault::plc_value) << "as much of the quay is where the charge has it";
  run(Pose::Identity());
  EXPECT_EQ(finding.faults, 0) << finding.reason;
}

TEST(MachineWitness, ATopOfAlmostNoSlopeAccusesNoTravelOfKilometres) {
  QuayConfig quay;
  quay.height = 0.0;
  quay.slope = Eigen::Vector2d(1e-4, 1e-4);
  MachineWitness witness(quay, nullptr, quay_machine(), kRegion, kHull);
  MachineFinding finding;
  for (int i = 0; i < 20; ++i) {
    const QuayFrame frame =
        quay_frame(kWorking, Pose(Eigen::Translation3d(0.0, 0.0, 0.5)), static_cast<unsigned>(i), 400, {0});
    finding = witness.look(MeasurementTime{milliseconds(100) * i}, frame.scan, frame.views, frame.stand);
  }
  EXPECT_EQ(finding.faults, fault::plc_value);
  EXPECT_EQ(finding.reason.find("travel"), std::string::npos) << finding.reason;
}

TEST(MachineWitness, ATopIsNotFoundWithJointsOnTrialNorForgottenWhileItsPlaceIsInView) {
  MachineWitness witness({}, nullptr, quay_machine(), kRegion, kHull);
  int number = 0;
  const auto run = [&](int frames, double height, bool on_trial) {
    for (int i = 0; i < frames; ++i, ++number) {
      const QuayFrame frame = quay_frame(kWorking, Pose(Eigen::Translation3d(0.0, 0.0, height)),
                                         static_cast<unsigned>(number), 400, {0});
      (void)witness.look(MeasurementTime{milliseconds(100) * number}, frame.scan, frame.views, frame.stand,
                         on_trial);
    }
  };
  run(60, 0.0, true);
  EXPECT_FALSE(witness.found_top());
  run(30, 0.0, false);
  ASSERT_TRUE(witness.found_top());
  run(100, 2.0, false);  // a sensor that hangs two metres lower: the top is beyond the gate
  Joints luffed = kWorking;
  luffed.theta_p += radians(2.0);
  const QuayFrame back = quay_frame(luffed, misplaced(luffed, kWorking), 999, 400, {0});
  MachineFinding finding;
  for (int i = 0; i < 20; ++i, ++number) {
    finding = witness.look(MeasurementTime{milliseconds(100) * number}, back.scan, back.views, back.stand);
  }
  EXPECT_EQ(finding.faults, fault::plc_value) << "it was found at 0, and is looked for there";
}

TEST(MachineWitness, JointsThatHaveBeenCheckedFindTheTopAnew) {
  Frames frames(nullptr);
  frames.run(30, {0.0, 0.0, radians(2.0)}, kMostlyTop);
  EXPECT_NE(frames.run(20, {}, kMostlyTop).faults, 0);
  frames.witness().forget();
  EXPECT_EQ(frames.run(60, {}, kMostlyTop).faults, 0);
}

TEST(MachineWitness, WithoutQuayItSaysNothing) {
  QuayConfig off;
  off.top_is_witness = false;
  Frames frames(nullptr, off);
  EXPECT_FALSE(frames.witness().has_quay());
  EXPECT_EQ(frames.run(20, {3.0, 0.0, 0.0}).faults, 0);
}

}  // namespace
}  // namespace hulltrack
