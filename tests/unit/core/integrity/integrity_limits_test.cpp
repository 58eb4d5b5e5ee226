#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <tuple>

#include "core/integrity/integrity.hpp"

namespace hulltrack {
namespace {

using ::testing::HasSubstr;

Eigen::Matrix3d variance(double sigma) { return sigma * sigma * Eigen::Matrix3d::Identity(); }

/// A right pose, well seen: 95 % of each class confirmed, 1 cm and 0.02 deg sure, nothing to correct.
IntegrityReport right_pose() {
  IntegrityReport report;
  report.surfaces.fill({400, 380});
  report.expected = 1200;
  report.confirmed = 1140;
  report.seen_through = 12;
  report.step.solved = true;
  report.step.covariance_translation = variance(0.01);
  report.step.covariance_rotation = variance(radians(0.02));
  report.landmarks.in_view = 40;
  report.landmarks.judged = 38;
  report.landmarks.solid = 38;
  report.landmarks.decided = true;
  return report;
}

struct Case {
  const char* name;
  std::function<void(IntegrityReport&)> change;  // of a right pose's report
  Faults faults;
  const char* words;  // in the reason
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class JudgeIntegrity : public testing::TestWithParam<Case> {};

TEST_P(JudgeIntegrity, FindsIt) {
  IntegrityReport report = right_pose();
  GetParam().change(report);
  const IntegrityFinding finding = judge_integrity(report);
  EXPECT_EQ(finding.faults, GetParam().faults) << finding.reason;
  EXPECT_EQ(finding.reason.empty(), finding.faults == 0) << finding.reason;
  EXPECT_THAT(finding.reason, HasSubstr(GetParam().words));
}

constexpr std::size_t kTransverse = 0;
constexpr std::size_t kLongitudinal = 1;
constexpr std::size_t kHorizontal = 2;
constexpr Faults kNone = 0;
constexpr Faults kContradicted = fault::contradicted;
constexpr Faults kUnconstrained = fault::unconstrained;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using R = IntegrityReport;
const Case kCases[] = {
    {"RightPose", [](R&) {}, kNone, ""},

    // By the step: what it says and three times its sigma must stay within 5 cm and 0.1 deg.
    {"StepWithinTheBudget",
     [](R& r) {
       r.step.translation = {0.0, 0.019, 0.0};
     },
     kNone, ""},
    {"StepBeyondTheBudget",
     [](R& r) {
       r.step.translation = {0.0, -0.021, 0.0};
     },
     kContradicted, "off by 0.000, -0.021, 0.000 m in x, y, z"},
    {"StepBeyondTheBudgetAcrossAxes",
     [](R& r) {
       r.step.translation = {0.05, 0.05, 0.05};
     },
     kContradicted, "off by 0.050, 0.050, 0.050 m"},
    {"SameStepLessSure",
     [](R& r) {
       r.step.translation = {0.0, 0.019, 0.0};
       r.step.covariance_translation(2, 2) = 0.012 * 0.012;
     },
     kContradicted, "off by 0.000, 0.019, 0.000 m"},
    {"TurnWithinTheBudget",
     [](R& r) {
       r.step.rotation = {0.0, 0.0, radians(0.039)};
     },
     kNone, ""},
    {"TurnBeyondTheBudget",
     [](R& r) {
       r.step.rotation = {0.0, 0.0, radians(-0.042)};
     },
     kContradicted, "turned by 0.042 deg"},

    // Unconstrained: by the geometry, or because too little is confirmed.
    {"StepNotSolved", [](R& r) { r.step = PlaneStep{}; }, kUnconstrained, "leave a direction free"},
    {"LessSureThanTranslationAllows", [](R& r) { r.step.covariance_translation(0, 0) = 0.038 * 0.038; },
     kUnconstrained, "to 0.038 m"},
    {"JustSureEnoughInTranslation", [](R& r) { r.step.covariance_translation(0, 0) = 0.0124 * 0.0124; },
     kNone, ""},
    {"LessSureAlongADiagonal",
     [](R& r) {  // 0.03 m in x and in y, fully correlated: 0.042 m along the diagonal
       r.step.covariance_translation.topLeftCorner<2, 2>().setConstant(0.03 * 0.03);
     },
     kUnconstrained, "to 0.042 m"},
    {"LessSureThanRotationAllows", [](R& r) { r.step.covariance_rotation = variance(radians(0.12)); },
     kUnconstrained, "0.120 deg"},
    {"TooFewConfirmed", [](R& r) { r.confirmed = 39; }, kUnconstrained,
     "only 39 map surfaces are confirmed by the scan, 40 are needed"},
    {"NothingSeen", [](R& r) { r = IntegrityReport{}; }, kUnconstrained, "only 0 map surfaces"},

    // By the share of a class that is where the pose puts it.
    {"HalfOfTheTransverseConfirmed",
     [](R& r) {
       r.surfaces[kTransverse] = {400, 200};
     },
     kNone, ""},
    {"TransverseMissing",
     [](R& r) {
       r.surfaces[kTransverse] = {400, 48};
     },
     kContradicted, "only 12 % of 400 transverse surfaces"},
    {"LongitudinalMissing",
     [](R& r) {
       r.surfaces[kLongitudinal] = {400, 199};
     },
     kContradicted, "400 longitudinal surfaces"},
    {"HorizontalMissing",
     [](R& r) {
       r.surfaces[kHorizontal] = {20, 9};
     },
     kContradicted, "only 45 % of 20 horizontal surfaces"},
    {"TooFewOfAClassSayNothing",
     [](R& r) {
       r.surfaces[kTransverse] = {19, 0};
     },
     kNone, ""},
    {"ClassNotInViewSaysNothing",
     [](R& r) {
       r.surfaces[kTransverse] = {0, 0};
     },
     kNone, ""},

    // By what the scan sees through.
    {"FiveInAHundredSeenThrough", [](R& r) { r.seen_through = 60; }, kNone, ""},
    {"MoreSeenThrough", [](R& r) { r.seen_through = 84; }, kContradicted, "sees through 7 % of the hull"},

    // Findings add up; the first reason that contradicts is the one that is told.
    {"ContradictedAndUnconstrained",
     [](R& r) {
       r.surfaces[kTransverse] = {400, 48};
       r.step = PlaneStep{};
     },
     kContradicted | kUnconstrained, "transverse surfaces"},
    {"ContradictedTwice",
     [](R& r) {
       r.seen_through = 120;
       r.step.translation = {0.5, 0.0, 0.0};
     },
     kContradicted, "sees through 10 %"},
};

INSTANTIATE_TEST_SUITE_P(Reports, JudgeIntegrity, testing::ValuesIn(kCases),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(JudgeIntegrityOfNan, FiguresThatAreNoNumbersAreNeverHealthy) {
  const std::function<void(IntegrityReport&)> spoil[] = {
      [](R& r) { r.step.translation.x() = kNan; },
      [](R& r) { r.step.rotation.z() = kNan; },
      [](R& r) { r.step.covariance_translation(0, 0) = kNan; },
      [](R& r) { r.step.covariance_rotation(2, 2) = kNan; },
      [](R& r) { r.step.covariance_translation.fill(kNan); },
      [](R& r) { r.step.covariance_rotation.fill(kNan); },
  };
  for (std::size_t i = 0; i < std::size(spoil); ++i) {
    IntegrityReport report = right_pose();
    spoil[i](report);
    EXPECT_NE(judge_integrity(report).faults, 0) << i;
  }
}

TEST(JudgeAlternative, APlaceThatConfirmsHalfOfWhatTheFramesOwnDoesIsNone) {
  const IntegrityReport there = right_pose();
  EXPECT_TRUE(is_alternative(there, there.confirmed));
  EXPECT_TRUE(is_alternative(there, there.confirmed * 3 / 2));
  EXPECT_FALSE(is_alternative(there, there.confirmed * 2));
}

TEST(JudgeAlternative, APlaceThatTheScanContradictsIsNoneHoweverMuchItConfirms) {
  IntegrityReport there = right_pose();
  there.seen_through = 200;
  EXPECT_FALSE(is_alternative(there, there.confirmed / 2));
}

TEST(JudgeAlternative, APlaceThatIsNotKnownToBeTheMapsShipMayBeOne) {
  IntegrityReport there = right_pose();
  there.landmarks.decided = false;
  EXPECT_TRUE(is_alternative(there, there.confirmed));
}

TEST(JudgeShip, FourDisplacedLandmarksTwoPiecesOfRimOrOneWallSetBackAreAnotherShip) {
  for (const auto& [displaced, rims, set_back, other] : {std::tuple{0U, 0U, 0U, false},
                                                         {3U, 0U, 0U, false},
                                                         {1U, 1U, 0U, false},
                                                         {4U, 0U, 0U, true},
                                                         {2U, 2U, 0U, true},
                                                         {1U, 0U, 1U, true}}) {
    IntegrityReport report = right_pose();
    report.landmarks.displaced = displaced;
    report.landmarks.displaced_rims = rims;
    report.landmarks.set_back = set_back;
    report.landmarks.median_offset = 0.12;
    const IntegrityFinding finding = judge_integrity(report);
    EXPECT_EQ(finding.faults, other ? kContradicted : kNone) << displaced << " and " << rims;
    EXPECT_EQ(finding.reason.find("another ship") != std::string::npos, other) << finding.reason;
  }
}

TEST(JudgeShip, OfAHundredLandmarksTwoPiecesOfRimAreNoOtherShip) {
  IntegrityReport report = right_pose();
  report.landmarks.displaced = 2;
  report.landmarks.displaced_rims = 2;
  report.landmarks.solid = 110;
  EXPECT_EQ(judge_integrity(report).faults, kNone);
  report.landmarks.displaced = 3;
  EXPECT_EQ(judge_integrity(report).faults, kContradicted);
}

TEST(JudgeShip, WhereAsManyStructuresDisagreeAsAgreeNobodyKnows) {
  for (const auto& [in_place, displaced, other] : {std::tuple{0U, 0U, false},
                                                   {1U, 0U, false},
                                                   {2U, 1U, false},
                                                   {1U, 1U, true},
                                                   {0U, 1U, true},
                                                   {1U, 2U, true}}) {
    for (const bool along : {true, false}) {
      IntegrityReport report = right_pose();
      (along ? report.landmarks.along : report.landmarks.across) = {in_place, displaced};
      const IntegrityFinding finding = judge_integrity(report);
      EXPECT_EQ(finding.faults, other ? kContradicted : kNone) << in_place << " and " << displaced;
      EXPECT_EQ(finding.reason.find(along ? "along the ship" : "across the ship") != std::string::npos, other)
          << finding.reason;
    }
  }
}

TEST(JudgeShip, AShipThatIsNotDecidedOnIsNoFaultButSaidSo) {
  IntegrityReport report = right_pose();
  report.landmarks.decided = false;
  const IntegrityFinding finding = judge_integrity(report);
  EXPECT_TRUE(finding.undecided);
  EXPECT_EQ(finding.faults, kNone);
  EXPECT_FALSE(finding.reason.empty());
}

}  // namespace
}  // namespace hulltrack
