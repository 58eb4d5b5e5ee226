#include "core/quay/misplacement.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/registration/plane_system.hpp"

namespace hulltrack {
namespace {

// Kernels of the least squares steps, m. The narrow ones are tried first: a machine within its class shows
// the quay at most 20 cm off, and from there they find it. Wrong returns, even far ones that could turn much,
// pull little. The wide kernels are tried if too few agree; they reach as far as the observer's gate.
constexpr std::array<double, 3> kNarrow = {0.10, 0.05, 0.05};
constexpr std::array<double, 5> kWide = {0.60, 0.30, 0.10, 0.05, 0.05};
constexpr double kSettled = 5e-4;    // m: after a smaller step the same kernel is not used again
constexpr double kAgrees = 0.10;     // m, of a residual: two kernels, five sigma of a return
constexpr double kExplained = 0.9;   // share that agrees without wide kernels; in place 0.97 to 0.99 do
constexpr double kMuchBetter = 1.1;  // times as many have to agree with the wide fit, or the narrow one stays

/// One observation: by how much each part of a twist about the centre changes its offset.
struct Lever {
  Eigen::Vector3d turn, shift;
  double offset;

  Lever(const QuayObservation& o, const Eigen::Vector3d& centre)
      : turn((o.p_W - centre).cross(o.n_W)), shift(o.n_W), offset(o.offset) {}

  [[nodiscard]] double residual(const Twist& twist) const {
    return offset - turn.dot(twist.head<3>()) - shift.dot(twist.tail<3>());
  }
};

/// The same as a row of the least squares.
struct Row : Lever {
  PlaneSystem::Vector7 weighed;  // in PlaneSystem's units

  Row(const QuayObservation& o, const Eigen::Vector3d& centre, const PlaneSystem& system)
      : Lever(o, centre), weighed(system.jacobian(o.p_W, o.n_W, 0.0)) {}
};

/// Directions are compared with rotations times kLever, so that both parts of a twist are in metres: a
/// direction of a twist in rad and m is `in_metres()` times one in metres, and its inverse takes it back.
Twist in_metres() {
  Twist scale;
  scale << Eigen::Vector3d::Constant(PlaneSystem::kLever), Eigen::Vector3d::Ones();
  return scale;
}

struct Fit {
  Twist twist = Twist::Zero();
  Matrix6 H = Matrix6::Zero();
  std::uint32_t agreeing = 0;
};

Fit fit(std::span<const Row> rows, const Eigen::Vector3d& centre, std::span<const double> kernels) {
  Fit fit;
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    PlaneSystem system(centre, kernels[i]);
    for (const Row& row : rows) {
      system.add(row.weighed, row.residual(fit.twist));
    }
    const Twist step = system.solve().twist;
    fit.twist -= step;  // the step moves returns onto planes; E moves planes to where the returns are
    fit.H = system.normal_matrix();
    const bool again = i + 1 < kernels.size() && kernels[i + 1] == kernels[i];
    if (again && PlaneSystem::kLever * step.head<3>().norm() + step.tail<3>().norm() < kSettled) {
      break;
    }
  }
  for (const Row& row : rows) {
    fit.agreeing += std::abs(row.residual(fit.twist)) <= kAgrees ? 1 : 0;
  }
  return fit;
}

/// One measurement for each direction that kFewestPairs hold.
std::vector<Misplacement::Measurement> measurements(const Fit& fit) {
  const Twist scale = in_metres();
  const Twist inverse = scale.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(inverse.asDiagonal() * fit.H * inverse.asDiagonal());
  std::vector<Misplacement::Measurement> measured;
  for (int i = 0; i < 6; ++i) {
    const double eigenvalue = eigen.eigenvalues()[i];
    if (eigenvalue >= PlaneSystem::kFewestPairs) {
      const Twist direction = scale.cwiseProduct(eigen.eigenvectors().col(i));
      const double sigma = std::hypot(
          PlaneSystem::kInflation * PlaneSystem::kPairSigma / std::sqrt(eigenvalue), Misplacement::kShared);
      measured.push_back({direction, direction.dot(fit.twist), sigma});
    }
  }
  return measured;
}

}  // namespace

bool Misplacement::agrees(const QuayObservation& o) const {
  return std::abs(Lever(o, centre_W).residual(twist)) <= kAgrees;
}

std::vector<Twist> Misplacement::unheld() const {
  const Twist inverse = in_metres().cwiseInverse();
  Eigen::MatrixXd held = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(kDirections), 6);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    held.row(static_cast<Eigen::Index>(i)) = inverse.cwiseProduct(measured[i].direction).transpose();
  }
  std::vector<Twist> twists;
  if (!holds_all()) {
    const Eigen::MatrixXd kernel = Eigen::FullPivLU<Eigen::MatrixXd>(held).kernel();
    for (Eigen::Index i = 0; i < kernel.cols(); ++i) {
      twists.emplace_back(inverse.cwiseProduct(kernel.col(i).normalized()));
    }
  }
  return twists;
}

Misplacement find_misplacement(std::span<const QuayObservation> observations) {
  Misplacement found;
  found.observations = static_cast<std::uint32_t>(observations.size());
  if (observations.empty()) {
    return found;
  }
  for (const QuayObservation& o : observations) {
    found.centre_W += o.p_W / static_cast<double>(observations.size());
  }
  std::vector<Row> rows;
  rows.reserve(observations.size());
  const PlaneSystem about_centre(found.centre_W, kAgrees);
  for (const QuayObservation& o : observations) {
    rows.emplace_back(o, found.centre_W, about_centre);
  }
  Fit best = fit(rows, found.centre_W, kNarrow);
  if (best.agreeing < kExplained * double(rows.size())) {
    const Fit wide = fit(rows, found.centre_W, kWide);
    if (wide.agreeing > kMuchBetter * best.agreeing) {
      best = wide;
    }
  }
  found.twist = best.twist;
  found.agreeing = best.agreeing;
  found.measured = measurements(best);
  return found;
}

}  // namespace hulltrack
