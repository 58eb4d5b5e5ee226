#include "core/registration/plane_system.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <limits>
#include <random>
#include <vector>

namespace hulltrack {
namespace {

using Vector7 = PlaneSystem::Vector7;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Eigen::Vector3d kCentre(40.0, -20.0, 8.0);

/// A point that shall lie on the plane through `on` with normal `n`.
struct Pair {
  Eigen::Vector3d p;
  Eigen::Vector3d on;
  Eigen::Vector3d n;
  double rise;
};

/// Points on small planes that face everywhere, over 60 x 20 x 6 m about kCentre.
std::vector<Pair> planes_everywhere(int count, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::normal_distribution<double> normal;
  std::vector<Pair> pairs;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d d(30.0 * unit(random), 10.0 * unit(random), 3.0 * unit(random));
    const Eigen::Vector3d n = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    pairs.push_back({kCentre + d, kCentre + d, n, d.x() * d.x() / 900.0});
  }
  return pairs;
}

/// Points on level planes at heights 0 .. `decks` - 1 times 4 m.
std::vector<Pair> level_planes(int decks, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Pair> pairs;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d p =
        kCentre + Eigen::Vector3d(20.0 * unit(random), 10.0 * unit(random), 4.0 * (i % decks));
    pairs.push_back({p, p, Eigen::Vector3d::UnitZ(), 0.0});
  }
  return pairs;
}

double residual(const Pair& pair, const Pose& T, double bend) {
  return pair.n.dot(T * pair.p - pair.on) - bend * pair.rise * pair.n.z();
}

PlaneSystem system_of(const std::vector<Pair>& pairs, const Pose& T, double bend, double kernel) {
  PlaneSystem system(kCentre, kernel);
  for (const Pair& pair : pairs) {
    system.add(T * pair.p, pair.n, residual(pair, T, bend), pair.rise);
  }
  return system;
}

Pose small_motion(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Twist twist;
  for (int i = 0; i < 6; ++i) {
    twist[i] = (i < 3 ? 0.005 : 0.1) * unit(random);
  }
  return pose_from_twist_about(kCentre, twist);
}

/// The least squares answer of weighted rows "jacobian x = -r" by QR, for the chosen parameters.
Eigen::VectorXd by_qr(const std::vector<Pair>& pairs, const PlaneSystem& system, Eigen::Index first,
                      Eigen::Index count, double prior_worth, double prior_off) {
  const auto rows = static_cast<Eigen::Index>(pairs.size());
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(rows + 1, count);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(rows + 1);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Pair& pair = pairs[static_cast<std::size_t>(i)];
    const double r = residual(pair, Pose::Identity(), 0.0);
    const double root = std::sqrt(system.weight_of(r));
    J.row(i) = root * system.jacobian(pair.p, pair.n, pair.rise).segment(first, count).transpose();
    b[i] = -root * r;
  }
  if (first + count == 7) {
    J(rows, count - 1) = std::sqrt(prior_worth);
    b[rows] = -std::sqrt(prior_worth) * prior_off;
  }
  return J.colPivHouseholderQr().solve(b);
}

TEST(PlaneSystem, JacobianIsTheSlopeOfTheResidualUnderATwistAboutTheCentreAndABend) {
  std::mt19937 random(1);
  const PlaneSystem system(kCentre, 0.1);
  constexpr double kStep = 1e-5;
  for (const Pair& pair : planes_everywhere(50, random)) {
    const Vector7 j = system.jacobian(pair.p, pair.n, pair.rise);
    for (int i = 0; i < 7; ++i) {
      const auto at = [&](double x) {
        Twist twist = Twist::Zero();
        if (i < 6) {
          twist[i] = i < 3 ? x / PlaneSystem::kLever : x;
        }
        return residual(pair, pose_from_twist_about(kCentre, twist), i == 6 ? x : 0.0);
      };
      EXPECT_NEAR(j[i], (at(kStep) - at(-kStep)) / (2.0 * kStep), 1e-8) << i;
    }
  }
}

TEST(PlaneSystem, SlopeIsTheDerivativeOfWeightTimesResidual) {
  const PlaneSystem system(kCentre, 0.03);
  const auto pull = [&](double r) { return system.weight_of(r) * r; };
  constexpr double kStep = 1e-6;
  for (double r = -0.2; r <= 0.2; r += 0.0037) {
    EXPECT_NEAR(system.slope_of(r), (pull(r + kStep) - pull(r - kStep)) / (2.0 * kStep), 1e-7) << r;
  }
}

TEST(PlaneSystem, APairOneKernelOffCountsAQuarter) {
  const PlaneSystem system(kCentre, 0.05);
  EXPECT_DOUBLE_EQ(system.weight_of(0.0), 1.0);
  EXPECT_DOUBLE_EQ(system.weight_of(0.05), 0.25);
  EXPECT_DOUBLE_EQ(system.weight_of(-0.05), 0.25);
}

TEST(PlaneSystem, PlantedMotionIsUndoneExactlyWithinAFewSteps) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Pair> pairs = planes_everywhere(200, random);
    const Pose planted = small_motion(random);
    for (Pair& pair : pairs) {
      pair.p = planted.inverse() * pair.p;
    }
    Pose T = Pose::Identity();
    for (int step = 0; step < 6; ++step) {
      const PlaneSystem::Solution solution = system_of(pairs, T, 0.0, 1.0).solve();
      EXPECT_EQ(solution.free, 0);
      EXPECT_EQ(solution.bend, 0.0);
      T = pose_from_twist_about(kCentre, solution.twist) * T;
    }
    EXPECT_TRUE(T.isApprox(planted, 1e-10)) << (T.inverse() * planted).matrix();
  }
}

TEST(PlaneSystem, ShiftAloneIsTheLeastSquaresAnswerWithoutATurn) {
  std::mt19937 random(3);
  std::vector<Pair> pairs = planes_everywhere(200, random);
  const Pose planted = small_motion(random);
  for (Pair& pair : pairs) {
    pair.p = planted * pair.p;
  }
  const PlaneSystem system = system_of(pairs, Pose::Identity(), 0.0, 0.1);
  const PlaneSystem::Solution solution = system.solve_shift();
  EXPECT_EQ(solution.free, 0);
  EXPECT_EQ(solution.twist.head<3>(), Eigen::Vector3d::Zero());
  EXPECT_EQ(solution.bend, 0.0);
  EXPECT_LT((solution.twist.tail<3>() - by_qr(pairs, system, 3, 3, 0.0, 0.0)).norm(), 1e-10);
}

TEST(PlaneSystem, ThePriorOfTheBendCountsAsOneMorePair) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::vector<Pair> pairs = planes_everywhere(200, random);
  for (Pair& pair : pairs) {
    pair.p += noise(random) * pair.n;
  }
  const PlaneSystem system = system_of(pairs, Pose::Identity(), 0.0, 0.05);
  for (const double information : {0.0, 0.5, 10.0, 1e4}) {
    for (const double off : {0.0, 0.04, -0.1}) {
      const PlaneSystem::Solution solution = system.solve(off, information);
      Eigen::VectorXd x = by_qr(pairs, system, 0, 7, information, off);
      x.head<3>() /= PlaneSystem::kLever;
      EXPECT_LT((solution.twist - x.head<6>()).norm(), 1e-10) << information << ", " << off;
      EXPECT_NEAR(solution.bend, x[6], 1e-10) << information << ", " << off;
    }
  }
}

TEST(PlaneSystem, ABendOfInfiniteWorthStaysAndOneOfNoWorthIsFound) {
  std::mt19937 random(5);
  constexpr double kBend = 0.03;
  std::vector<Pair> pairs = planes_everywhere(300, random);
  for (Pair& pair : pairs) {
    pair.p.z() += kBend * pair.rise;
  }
  const PlaneSystem system = system_of(pairs, Pose::Identity(), 0.0, 10.0);
  const PlaneSystem::Solution held = system.solve(0.01, kInfinity);
  EXPECT_EQ(held.bend, 0.0);
  EXPECT_EQ(held.twist, system.solve().twist);
  EXPECT_GT(held.twist.norm(), 1e-3) << "the pose takes up what the bend may not";

  const PlaneSystem::Solution found = system.solve(0.01, 0.0);
  EXPECT_NEAR(found.bend, kBend, 1e-6);
  EXPECT_LT(found.twist.norm(), 1e-6);
}

TEST(PlaneSystem, LevelPlanesLeaveThreeDirectionsFreeAndNothingMovesAlongThem) {
  std::mt19937 random(6);
  for (const int decks : {1, 2}) {
    std::vector<Pair> pairs = level_planes(decks, random);
    const Pose planted =
        pose_from_twist_about(kCentre, (Twist() << 0.004, -0.003, 0.01, 0.1, -0.08, 0.05).finished());
    for (Pair& pair : pairs) {
      pair.p = planted.inverse() * pair.p;
    }
    Pose T = Pose::Identity();
    Twist sum = Twist::Zero();
    for (int step = 0; step < 6; ++step) {
      const PlaneSystem::Solution solution = system_of(pairs, T, 0.0, 1.0).solve();
      EXPECT_EQ(solution.free, 3) << decks;
      EXPECT_LT(Eigen::Vector3d(solution.twist[2], solution.twist[3], solution.twist[4]).norm(), 1e-12);
      T = pose_from_twist_about(kCentre, solution.twist) * T;
      sum += solution.twist;
    }
    for (const Pair& pair : pairs) {
      EXPECT_NEAR(residual(pair, T, 0.0), 0.0, 1e-9);
    }
    EXPECT_EQ(system_of(pairs, T, 0.0, 1.0).solve_shift().free, 2);
  }
}

TEST(PlaneSystem, ADirectionIsHeldByMoreThanTenPairsThatFaceItAndNotByFewer) {
  std::mt19937 random(7);
  for (const int facing : {9, 11}) {
    std::vector<Pair> pairs = level_planes(2, random);
    for (const Pair& deck : level_planes(2, random)) {
      pairs.push_back({deck.p, deck.p, Eigen::Vector3d::UnitY(), 0.0});
    }
    PlaneSystem system = system_of(pairs, Pose::Identity(), 0.0, 1.0);
    for (int i = 0; i < facing; ++i) {  // in the centre: they hold no turn
      system.add(kCentre, Eigen::Vector3d::UnitX(), 0.0);
    }
    EXPECT_EQ(system.solve().free, facing == 11 ? 0 : 1);
    EXPECT_EQ(system.solve_shift().free, facing == 11 ? 0 : 1);
  }
}

TEST(PlaneSystem, WithoutPairsEverythingIsFreeAndNothingMoves) {
  const PlaneSystem system(kCentre, 0.1);
  for (const PlaneSystem::Solution& solution :
       {system.solve(), system.solve(0.0, 0.0), system.solve(0.1, 5.0)}) {
    EXPECT_EQ(solution.free, 6);
    EXPECT_EQ(solution.twist, Twist::Zero());
  }
  EXPECT_EQ(system.solve_shift().free, 3);
  EXPECT_EQ(system.rms(), 0.0);
  EXPECT_EQ(system.pairs(), 0u);
}

TEST(PlaneSystem, NormalMatrixAndRmsAreTheSumsOverItsPairs) {
  std::mt19937 random(8);
  std::normal_distribution<double> noise(0.0, 0.03);
  std::vector<Pair> pairs = planes_everywhere(100, random);
  Matrix6 sum = Matrix6::Zero();
  double squares = 0.0;
  double weights = 0.0;
  for (Pair& pair : pairs) {
    const double r = noise(random);
    pair.p += r * pair.n;
    const double w = std::pow(0.0025 / (0.0025 + r * r), 2);
    Twist j;
    j << (pair.p - kCentre).cross(pair.n), pair.n;
    sum += w * j * j.transpose();
    squares += w * r * r;
    weights += w;
  }
  const PlaneSystem system = system_of(pairs, Pose::Identity(), 0.0, 0.05);
  EXPECT_TRUE(system.normal_matrix().isApprox(sum, 1e-9));
  EXPECT_NEAR(system.rms(), std::sqrt(squares / weights), 1e-12);
  EXPECT_EQ(system.pairs(), 100u);
}

TEST(PlaneSystem, ATwistAboutACentreTurnsTheCentreNowhere) {
  const Twist twist = (Twist() << 0.1, -0.2, 0.3, 1.0, 2.0, 3.0).finished();
  const Pose T = pose_from_twist_about(kCentre, twist);
  EXPECT_TRUE((T * kCentre).isApprox(kCentre + Eigen::Vector3d(1.0, 2.0, 3.0), 1e-12));
  EXPECT_TRUE(so3_log(T.linear()).isApprox(Eigen::Vector3d(0.1, -0.2, 0.3), 1e-12));
}

}  // namespace
}  // namespace hulltrack
