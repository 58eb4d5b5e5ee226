#include "core/quay/surface_cells.hpp"

#include <algorithm>
#include <cmath>

namespace hulltrack {
namespace {

constexpr float kFarthest = 1e5F;  // m: farther away nothing is added and nothing found
constexpr float kHalfDiagonal = 0.8661F * SurfaceCells::kCell;

int cell(float v) { return rounded_down(v * (1.0F / SurfaceCells::kCell)); }

float middle_of(int cell) { return (static_cast<float>(cell) + 0.5F) * SurfaceCells::kCell; }

}  // namespace

void SurfaceCells::add(const Point& middle, const Point& normal, float along, float beside,
                       SurfaceClass surface) {
  if (!(middle.cwiseAbs().maxCoeff() < kFarthest)) {
    return;
  }
  const auto bit = static_cast<Classes>(1U << static_cast<unsigned>(surface));
  const float reach = std::hypot(along, beside) + kHalfDiagonal;
  const float most_beside2 = (beside + kHalfDiagonal) * (beside + kHalfDiagonal);
  for (int x = cell(middle.x() - reach); x <= cell(middle.x() + reach); ++x) {
    for (int y = cell(middle.y() - reach); y <= cell(middle.y() + reach); ++y) {
      for (int z = cell(middle.z() - reach); z <= cell(middle.z() + reach); ++z) {
        const Point d = Point(middle_of(x), middle_of(y), middle_of(z)) - middle;
        const float off = normal.dot(d);
        if (std::abs(off) > along + kHalfDiagonal || d.squaredNorm() - off * off > most_beside2) {
          continue;
        }
        const std::uint32_t place = 1 + index_.add(x >> kBits, y >> kBits, z >> kBits);
        if (place == blocks_.size()) {
          blocks_.emplace_back().fill(0);
        }
        blocks_[place][in_block(x, y, z)] |= bit;
      }
    }
  }
}

SurfaceCells::Classes SurfaceCells::at(const Point& p) const {
  if (!(p.cwiseAbs().maxCoeff() < kFarthest)) {
    return 0;
  }
  const int x = cell(p.x());
  const int y = cell(p.y());
  const int z = cell(p.z());
  // Where there is no block kNone + 1 is 0, and the empty block answers. So there is no branch, which the
  // processor could not predict.
  static_assert(BlockIndex::kNone + 1U == 0U);
  const std::uint32_t place = 1 + index_.find(x >> kBits, y >> kBits, z >> kBits);
  return blocks_[place][in_block(x, y, z)];
}

std::size_t SurfaceCells::in_block(int x, int y, int z) {
  constexpr unsigned kMask = (1U << kBits) - 1;
  const auto part = [](int v) { return static_cast<std::size_t>(static_cast<unsigned>(v) & kMask); };
  return (part(x) << (2 * kBits)) | (part(y) << kBits) | part(z);
}

}  // namespace hulltrack
