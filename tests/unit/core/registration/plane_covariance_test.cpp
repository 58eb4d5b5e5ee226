#include "core/registration/plane_covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <random>

namespace hulltrack {
namespace {

constexpr double kKernel = 0.03;  // m
constexpr int kPerCluster = 25;
constexpr int kScenes = 400;
constexpr BendShape kShape{0.0, 60.0};

struct Pair {
  Eigen::Vector3d p;
  Eigen::Vector3d n;
  std::uint32_t cluster;
};

/// Clusters of 2 x 2 m on the six sides of a box of 40 x 20 x 6 m, one side after the other.
std::vector<Pair> box_of_clusters(std::uint32_t clusters, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Eigen::Vector3d half(20.0, 10.0, 3.0);
  std::vector<Pair> pairs;
  for (std::uint32_t cluster = 0; cluster < clusters; ++cluster) {
    const auto axis = static_cast<int>(cluster % 3);
    const double side = cluster % 6 < 3 ? -1.0 : 1.0;
    Eigen::Vector3d middle = half.cwiseProduct(Eigen::Vector3d(unit(random), unit(random), unit(random)));
    middle[axis] = side * half[axis];
    for (int i = 0; i < kPerCluster; ++i) {
      Eigen::Vector3d d(unit(random), unit(random), unit(random));
      d[axis] = 0.0;
      pairs.push_back({middle + d, Eigen::Vector3d::Unit(axis), cluster});
    }
  }
  return pairs;
}

/// How far each point is off its plane: what it has of its own and what its cluster has in common, m.
std::vector<double> draw_noise(const std::vector<Pair>& pairs, double own, double common,
                               std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::vector<double> noise;
  double shared = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i == 0 || pairs[i].cluster != pairs[i - 1].cluster) {
      shared = common * normal(random);
    }
    noise.push_back(shared + own * normal(random));
  }
  return noise;
}

struct Fit {
  Twist twist = Twist::Zero();  // the error, since the truth is zero
  PlaneCovariance covariance;
};

/// Fits a pose (linearly: errors are millimetres) to points off their planes by `noise`, the map bent by
/// `bend` more than the fit knows.
Fit fit(const std::vector<Pair>& pairs, const std::vector<double>& noise, double bend) {
  Fit out;
  PlaneCovarianceEstimator estimator;
  estimator.reset(pairs.back().cluster + 1);
  constexpr int kSteps = 6;
  for (int step = 1; step <= kSteps; ++step) {
    PlaneSystem system(Eigen::Vector3d::Zero(), kKernel);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto& [p, n, cluster] = pairs[i];
      const double rise = kShape.rise(p.x());
      const double r =
          noise[i] + bend * rise * n.z() + p.cross(n).dot(out.twist.head<3>()) + n.dot(out.twist.tail<3>());
      system.add(p, n, r, rise);
      if (step == kSteps) {
        estimator.add(system, cluster, p, n, r, rise);
      }
    }
    out.twist += system.solve().twist;
  }
  out.covariance = estimator.estimate();
  return out;
}

struct Campaign {
  double shared = 0.0;                // mean
  Matrix6 claimed = Matrix6::Zero();  // mean of pose * mean of shared
  Matrix6 sample = Matrix6::Zero();   // of the errors
  double bend_off = 0.0;              // mean
  double bend_scatter = 0.0;          // 1-sigma of bend_off
  double bend_sigma = 0.0;            // root mean square of what is claimed
};

Campaign run(double own, double common, double bend) {
  std::mt19937 random(1);
  const std::vector<Pair> pairs = box_of_clusters(48, random);
  Campaign out;
  double off2 = 0.0;
  double sigma2 = 0.0;
  for (int scene = 0; scene < kScenes; ++scene) {
    const Fit one = fit(pairs, draw_noise(pairs, own, common, random), bend);
    EXPECT_TRUE(one.covariance.valid);
    out.shared += one.covariance.shared / kScenes;
    out.claimed += one.covariance.pose / kScenes;
    out.sample += one.twist * one.twist.transpose() / kScenes;
    out.bend_off += one.covariance.bend_off / kScenes;
    off2 += one.covariance.bend_off * one.covariance.bend_off / kScenes;
    sigma2 += one.covariance.bend_sigma * one.covariance.bend_sigma / kScenes;
  }
  out.claimed *= out.shared;
  out.bend_scatter = std::sqrt(off2 - out.bend_off * out.bend_off);
  out.bend_sigma = std::sqrt(sigma2);
  return out;
}

/// The sample covariance in units of the claimed one has eigenvalues within (1 +- sqrt(6 / 400))^2 = 0.77 ..
/// 1.26 for Gaussian errors (Marchenko and Pastur); a tenth more for the shares that clusters differ by.
void expect_alike(const Matrix6& sample, const Matrix6& claimed) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> eigen(sample, claimed);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), 0.67) << eigen.eigenvalues().transpose();
  EXPECT_LT(eigen.eigenvalues().maxCoeff(), 1.36) << eigen.eigenvalues().transpose();
}

/// Correlation of weight * residual of two points whose noise has a part in common.
double correlation_of_pulls(double own, double common, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const PlaneSystem system(Eigen::Vector3d::Zero(), kKernel);
  double squares = 0.0;
  double products = 0.0;
  for (int i = 0; i < 200'000; ++i) {
    const double shared = common * normal(random);
    const double a = shared + own * normal(random);
    const double b = shared + own * normal(random);
    squares += std::pow(system.weight_of(a) * a, 2);
    products += system.weight_of(a) * a * system.weight_of(b) * b;
  }
  return products / squares;
}

/// trace(B^-1 B_clusters) / 6 where any two pulls of a cluster have this correlation.
double planted_ratio(const std::vector<Pair>& pairs, double correlation) {
  const PlaneSystem system(Eigen::Vector3d::Zero(), kKernel);
  Matrix6 B = Matrix6::Zero();
  std::vector<Twist> sums(pairs.back().cluster + 1, Twist::Zero());
  for (const Pair& pair : pairs) {
    const Twist j = system.jacobian(pair.p, pair.n, 0.0).head<6>();
    B += j * j.transpose();
    sums[pair.cluster] += j;
  }
  Matrix6 B_clusters = (1.0 - correlation) * B;
  for (const Twist& sum : sums) {
    B_clusters += correlation * sum * sum.transpose();
  }
  return B.ldlt().solve(B_clusters).trace() / 6.0;
}

TEST(PlaneCovariance, OfIndependentNoiseIsThatOfTheErrorsAndNothingIsShared) {
  const Campaign campaign = run(0.02, 0.0, 0.0);
  EXPECT_NEAR(campaign.shared, 1.0, 0.05);
  expect_alike(campaign.sample, campaign.claimed);
}

TEST(PlaneCovariance, SharedIsTheRatioOfClustersToPairsAndMakesTheCovarianceRight) {
  constexpr double kOwn = 0.0175;
  std::mt19937 random(1);
  const std::vector<Pair> pairs = box_of_clusters(48, random);  // those of run()
  for (const double common : {0.005, 0.01}) {
    const Campaign campaign = run(kOwn, common, 0.0);
    const double planted = planted_ratio(pairs, correlation_of_pulls(kOwn, common, random));
    EXPECT_GT(planted, 1.5);
    EXPECT_NEAR(campaign.shared, planted, 0.1 * planted) << common;
    expect_alike(campaign.sample, campaign.claimed);
  }
}

TEST(PlaneCovariance, BendOffIsTheBendThatTheFitDoesNotKnowWithItsScatter) {
  constexpr double kBend = 0.01;  // small against the kernel at the ends
  for (const double common : {0.0, 0.005}) {
    const Campaign campaign = run(0.0175, common, kBend);
    // 400 scenes: the mean is as good as a twentieth of one's scatter, the scatter to 3.5 %.
    EXPECT_NEAR(campaign.bend_off, kBend, 4.0 * campaign.bend_scatter / 20.0) << common;
    EXPECT_NEAR(campaign.bend_sigma, campaign.bend_scatter, 0.2 * campaign.bend_scatter) << common;
  }
}

TEST(PlaneCovariance, ByBendIsHowFarThePoseMovesWhenTheMapIsBent) {
  std::mt19937 random(2);
  const std::vector<Pair> pairs = box_of_clusters(48, random);
  const std::vector<double> none(pairs.size(), 0.0);
  constexpr double kBend = 1e-3;
  const PlaneCovariance covariance = fit(pairs, none, 0.0).covariance;
  const Twist moved = fit(pairs, none, kBend).twist / kBend;
  // Of either sign: what it is for is its square.
  EXPECT_TRUE((covariance.by_bend * covariance.by_bend.transpose()).isApprox(moved * moved.transpose(), 1e-2))
      << covariance.by_bend.transpose() << " / " << moved.transpose();
}

TEST(PlaneCovariance, FewerThanTwelveClustersAreTooFew) {
  std::mt19937 random(3);
  for (const std::uint32_t clusters : {6u, 11u, 12u}) {
    const std::vector<Pair> pairs = box_of_clusters(clusters, random);
    EXPECT_EQ(fit(pairs, draw_noise(pairs, 0.02, 0.0, random), 0.0).covariance.valid, clusters == 12u);
  }
  EXPECT_FALSE(PlaneCovarianceEstimator().estimate().valid);
}

TEST(PlaneCovariance, AFreeDirectionHasNone) {
  std::mt19937 random(4);
  std::vector<Pair> pairs = box_of_clusters(48, random);
  std::erase_if(pairs, [](const Pair& pair) { return pair.n.x() != 0.0; });
  EXPECT_FALSE(fit(pairs, draw_noise(pairs, 0.02, 0.0, random), 0.0).covariance.valid);
}

TEST(PlaneCovariance, OfWallsAloneSaysNothingAboutTheBend) {
  std::mt19937 random(5);
  PlaneCovarianceEstimator estimator;
  const std::vector<Pair> pairs = box_of_clusters(48, random);
  const PlaneSystem system(Eigen::Vector3d::Zero(), kKernel);
  estimator.reset(48);
  for (const Pair& pair : pairs) {
    estimator.add(system, pair.cluster, pair.p, pair.n, 0.01, 0.0);
  }
  const PlaneCovariance covariance = estimator.estimate();
  EXPECT_TRUE(covariance.valid);
  EXPECT_EQ(covariance.bend_sigma, 0.0);
  EXPECT_EQ(covariance.bend_off, 0.0);
}

TEST(PlaneCovariance, ResetForgetsEverything) {
  std::mt19937 random(6);
  const std::vector<Pair> pairs = box_of_clusters(48, random);
  const PlaneSystem system(Eigen::Vector3d::Zero(), kKernel);
  const auto add_all = [&](PlaneCovarianceEstimator& estimator) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto& [p, n, cluster] = pairs[i];
      estimator.add(system, cluster, p, n, i % 2 == 0 ? 0.01 : -0.01, kShape.rise(p.x()));
    }
  };
  PlaneCovarianceEstimator fresh;
  fresh.reset(48);
  add_all(fresh);
  PlaneCovarianceEstimator used;
  used.reset(60);
  add_all(used);
  used.reset(48);
  EXPECT_FALSE(used.estimate().valid);
  add_all(used);
  EXPECT_EQ(used.estimate().pose, fresh.estimate().pose);
  EXPECT_EQ(used.estimate().shared, fresh.estimate().shared);
}

}  // namespace
}  // namespace hulltrack
