#include "core/quay/quay_top.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/quay/misplacement.hpp"
#include "core/registration/plane_system.hpp"

namespace hulltrack {
namespace {

constexpr std::size_t kFewestReturns = 300;
constexpr double kLeastShare = 0.5;  // of the returns agree: else something else is as large as the top
constexpr float kAgrees = 0.10F;     // m, five sigma of a return
// Half of the returns are on the top, so one trial in eight has three of them: 100 fail once in 600,000
// times, and 500 are drawn for those that are discarded.
constexpr int kTrials = 100;
constexpr int kDraws = 500;
constexpr std::size_t kJudges = 500;  // returns that a trial is judged by
constexpr float kWide = 10.0F;        // m2: twice the area of a trial's triangle, level
constexpr int kFits = 3;
// Returns are spread by this, m, standard deviation, across the way in which they are spread least: then an
// error of 5 mm that they share turns the plane by 0.1 deg.
constexpr double kLeastSpread = 3.0;
constexpr double kOutlying = 0.05;  // of the returns at either end of the area: they may be of anything

/// z = c.z + c.x * x + c.y * y.
using Coefficients = Eigen::Vector3f;

float off(const Coefficients& c, const Point& p) { return p.z() - (c.x() * p.x() + c.y() * p.y() + c.z()); }

/// Numbers below `limit`, the same ones each time: a recording has to give the same answer again.
class Draw {
 public:
  std::size_t below(std::size_t limit) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>((state_ >> 33U) % limit);
  }

 private:
  std::uint64_t state_ = 1;
};

std::optional<Coefficients> through(const Point& a, const Point& b, const Point& c) {
  const Eigen::Vector3f normal = (b - a).cross(c - a);
  if (!(std::abs(normal.z()) >= kWide)) {
    return std::nullopt;
  }
  const float x = -normal.x() / normal.z();
  const float y = -normal.y() / normal.z();
  const auto steepest = static_cast<float>(std::tan(kSteepestQuay));
  if (std::abs(x) > steepest || std::abs(y) > steepest) {
    return std::nullopt;
  }
  return Coefficients(x, y, a.z() - x * a.x() - y * a.y());
}

std::optional<Coefficients> most_agreed_on(std::span<const Point> returns_W) {
  const std::size_t stride = std::max<std::size_t>(1, returns_W.size() / kJudges);
  std::optional<Coefficients> best;
  std::size_t most = 0;
  Draw draw;
  int trials = 0;
  for (int drawn = 0; drawn < kDraws && trials < kTrials; ++drawn) {
    std::array<Point, 3> of;
    for (Point& p : of) {
      p = returns_W[draw.below(returns_W.size())];
    }
    const std::optional<Coefficients> trial = through(of[0], of[1], of[2]);
    if (!trial) {
      continue;
    }
    ++trials;
    std::size_t agreeing = 0;
    for (std::size_t i = 0; i < returns_W.size(); i += stride) {
      agreeing += std::abs(off(*trial, returns_W[i])) <= kAgrees ? 1 : 0;
    }
    if (agreeing > most) {
      most = agreeing;
      best = trial;
    }
  }
  return best;
}

/// Sums over the returns that agree with a plane, about `middle` for the digits' sake.
struct Agreement {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();  // of (x, y, 1)
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double squares = 0.0;  // of what they are off by
  std::size_t count = 0;
};

Agreement agreeing_with(const Coefficients& c, std::span<const Point> returns_W, const Point& middle) {
  Agreement sums;
  for (const Point& p : returns_W) {
    if (std::abs(off(c, p)) > kAgrees) {
      continue;
    }
    const Eigen::Vector3d row(double(p.x()) - double(middle.x()), double(p.y()) - double(middle.y()), 1.0);
    sums.H += row * row.transpose();
    sums.b += row * (double(p.z()) - double(middle.z()));
    sums.squares += double(off(c, p)) * double(off(c, p));
    ++sums.count;
  }
  return sums;
}

/// Along X and Y; z is the box's, of no meaning.
Box area_of(const Coefficients& c, std::span<const Point> returns_W) {
  std::array<std::vector<float>, 2> along;
  for (const Point& p : returns_W) {
    if (std::abs(off(c, p)) <= kAgrees) {
      along[0].push_back(p.x());
      along[1].push_back(p.y());
    }
  }
  Box area;
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<float>& values = along[static_cast<std::size_t>(axis)];
    std::sort(values.begin(), values.end());
    const auto outlying = static_cast<std::size_t>(kOutlying * double(values.size()));
    area.min[axis] = values[outlying];
    area.max[axis] = values[values.size() - 1 - outlying];
  }
  return area;
}

}  // namespace

Eigen::Vector3d QuayPlane::normal() const {
  return Eigen::Vector3d(-std::tan(slope.x()), -std::tan(slope.y()), 1.0).normalized();
}

double QuayPlane::above(const Eigen::Vector3d& p_W) const {
  return normal().dot(p_W - Eigen::Vector3d(0.0, 0.0, height));
}

std::optional<SeenTop> find_quay_top(std::span<const Point> returns_W) {
  if (returns_W.size() < kFewestReturns) {
    return std::nullopt;
  }
  std::optional<Coefficients> plane = most_agreed_on(returns_W);
  if (!plane) {
    return std::nullopt;
  }
  const Point middle = returns_W.front();
  Agreement sums;
  for (int fit = 0; fit < kFits; ++fit) {
    sums = agreeing_with(*plane, returns_W, middle);
    if (double(sums.count) < kLeastShare * double(returns_W.size())) {
      return std::nullopt;
    }
    const Eigen::Vector3d c = sums.H.ldlt().solve(sums.b);
    const double at_origin =
        c.z() + double(middle.z()) - c.x() * double(middle.x()) - c.y() * double(middle.y());
    plane = Coefficients(static_cast<float>(c.x()), static_cast<float>(c.y()), static_cast<float>(at_origin));
  }
  const double n = static_cast<double>(sums.count);
  const Eigen::Vector2d mean = sums.H.block<2, 1>(0, 2) / n;
  const Eigen::Matrix2d spread = sums.H.topLeftCorner<2, 2>() / n - mean * mean.transpose();
  const double least = std::sqrt(std::max(
      0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread, Eigen::EigenvaluesOnly).eigenvalues()[0]));
  const Eigen::Vector2d slope(std::atan(double(plane->x())), std::atan(double(plane->y())));
  if (!(least >= kLeastSpread) || slope.cwiseAbs().maxCoeff() > kSteepestQuay) {
    return std::nullopt;
  }
  // A quay is uneven, and a part of it slopes otherwise than the whole.
  const double uneven =
      std::sqrt(std::max(0.0, sums.squares / n - PlaneSystem::kPairSigma * PlaneSystem::kPairSigma));
  const double sigma = std::hypot(PlaneSystem::kInflation * PlaneSystem::kPairSigma / std::sqrt(n),
                                  Misplacement::kShared, uneven);
  const Eigen::Vector2d at = mean + middle.head<2>().cast<double>();
  const double height = double(plane->z()) + double(plane->x()) * at.x() + double(plane->y()) * at.y();
  return SeenTop{
      {double(plane->z()), slope}, area_of(*plane, returns_W), {at.x(), at.y(), height}, sigma / least};
}

}  // namespace hulltrack
