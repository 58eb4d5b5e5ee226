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
constexpr double kLeastShare = 0.5;  // of the returns have to agree: else the plane may be something else's
constexpr float kAgrees = 0.10F;     // m off the plane: five sigma of a return
// A trial is a plane through three random returns. If half of the returns are on the top, one trial in eight
// has all three there, and 100 trials fail once in 600,000 times. Up to 500 triples are drawn, because some
// are discarded.
constexpr int kTrials = 100;
constexpr int kDraws = 500;
constexpr std::size_t kJudges = 500;  // returns that a trial is compared with
constexpr float kWide = 10.0F;        // m^2: twice the least level area of a trial's triangle
constexpr int kFits = 3;
// Returns on the plane have to be spread by this in the direction in which they are spread least, standard
// deviation, m. An error of 5 mm that they share then turns the plane by 0.1 deg.
constexpr double kLeastSpread = 3.0;
constexpr double kOutlying = 0.05;  // share at either end of the area that is cut off: it may be of anything

/// A plane: z = c.z + c.x * x + c.y * y.
using Coefficients = Eigen::Vector3f;

/// How far p is above the plane, m.
float off(const Coefficients& c, const Point& p) { return p.z() - (c.x() * p.x() + c.y() * p.y() + c.z()); }

/// Random numbers below `limit`, the same sequence each time: a replayed recording gives the same answer.
class Draw {
 public:
  std::size_t below(std::size_t limit) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>((state_ >> 33U) % limit);
  }

 private:
  std::uint64_t state_ = 1;
};

/// The plane through three points; nothing if they are too close together or it is too steep for a quay.
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

/// Sums over the returns that agree with a plane, for fitting it. Coordinates are taken from a `middle` near
/// them, which keeps the sums accurate.
struct Agreement {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();  // sum of r r^T, with r = (x, y, 1)
  Eigen::Vector3d b = Eigen::Vector3d::Zero();  // sum of r z
  double squares = 0.0;                         // sum of the squared distances from the plane, m^2
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

/// Where the returns on the plane lie along X and Y. The box's z has no meaning.
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
  // A quay is uneven, so a part of it slopes otherwise than the whole. What the distances from the plane
  // exceed the noise of a return by is taken for unevenness, and adds to the slope's sigma.
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
