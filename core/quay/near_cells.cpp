#include "core/quay/near_cells.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace hulltrack {
namespace {

constexpr float kFarthest = 1e5F;  // m: a place farther from the origin is near nothing
constexpr int kBits = 2;           // blocks of 4 x 4 x 4
constexpr int kSide = 1 << kBits;
constexpr int kMetre = 5;  // cells

/// Number of the cell's bit in its block.
unsigned place_of(int x, int y, int z) {
  constexpr int kMask = kSide - 1;
  return static_cast<unsigned>(((x & kMask) << (2 * kBits)) | ((y & kMask) << kBits) | (z & kMask));
}

}  // namespace

NearCells::NearCells(std::span<const Point> points) {
  BlockIndex index;
  std::vector<std::uint64_t> occupied;
  std::vector<Cell> blocks;  // the first cell of each block
  for (const Point& p : points) {
    if (is_far(p)) {
      continue;
    }
    const Cell cell = cell_of(p);
    const std::uint32_t block = index.add(cell.x >> kBits, cell.y >> kBits, cell.z >> kBits);
    occupied.resize(index.size(), 0);
    if ((occupied[block] & bit_of(cell)) == 0) {
      occupied[block] |= bit_of(cell);
      mark(cell, blocks);
    }
  }
  for (const Cell& block : blocks) {
    mark_level(block);
  }
}

/// Marks as near the cell and the 18 that share a face or an edge with it; not the eight at its corners.
void NearCells::mark(const Cell& cell, std::vector<Cell>& blocks) {
  columns_.add(cell.x >> kBits, cell.y >> kBits, 0);
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        if (std::abs(dx) + std::abs(dy) + std::abs(dz) > 2) {
          continue;
        }
        const Cell beside{cell.x + dx, cell.y + dy, cell.z + dz};
        const std::uint32_t place = 1 + index_.add(beside.x >> kBits, beside.y >> kBits, beside.z >> kBits);
        if (place == blocks_.size()) {
          blocks_.emplace_back();
          blocks.push_back({beside.x & ~(kSide - 1), beside.y & ~(kSide - 1), beside.z & ~(kSide - 1)});
        }
        blocks_[place].near |= bit_of(beside);
      }
    }
  }
}

/// Finds the block's cells that are inside a level surface. `block`: its first cell.
void NearCells::mark_level(const Cell& block) {
  constexpr std::array<std::array<int, 2>, 4> kSides = {
      {{kMetre, 0}, {-kMetre, 0}, {0, kMetre}, {0, -kMetre}}};
  std::uint64_t level = 0;
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const Cell cell{block.x + (i >> (2 * kBits)), block.y + ((i >> kBits) & (kSide - 1)),
                    block.z + (i & (kSide - 1))};
    const bool goes_on = near(cell) && std::all_of(kSides.begin(), kSides.end(), [&](const auto& side) {
                           return near(Cell{cell.x + side[0], cell.y + side[1], cell.z});
                         });
    level |= goes_on ? bit_of(cell) : 0;
  }
  blocks_[1 + index_.find(block.x >> kBits, block.y >> kBits, block.z >> kBits)].level = level;
}

bool NearCells::is_far(const Point& p) { return !(p.cwiseAbs().maxCoeff() < kFarthest); }

NearCells::Cell NearCells::cell_of(const Point& p) {
  const Point cells = p * (1.0F / kCell);
  return {rounded_down(cells.x()), rounded_down(cells.y()), rounded_down(cells.z())};
}

std::uint64_t NearCells::bit_of(const Cell& cell) {
  return std::uint64_t{1} << place_of(cell.x, cell.y, cell.z);
}

/// The cell's block, or the empty block blocks_[0] if it does not exist: kNone + 1 is 0. So there is no
/// branch, which the processor could not predict.
const NearCells::Block& NearCells::block_of(const Cell& cell) const {
  static_assert(BlockIndex::kNone + 1U == 0U);
  const std::uint32_t place = 1 + index_.find(cell.x >> kBits, cell.y >> kBits, cell.z >> kBits);
  return blocks_[place];
}

bool NearCells::near(const Cell& cell) const { return (block_of(cell).near & bit_of(cell)) != 0; }

NearCells::Answer NearCells::at(const Point& p) const {
  if (is_far(p)) {
    return {};
  }
  const Cell cell = cell_of(p);
  const Block& block = block_of(cell);
  const std::uint64_t bit = bit_of(cell);
  return {(block.near & bit) != 0, (block.level & bit) != 0};
}

bool NearCells::in_reach(const Point& p) const {
  if (is_far(p)) {
    return false;
  }
  const Cell cell = cell_of(p);
  return columns_.find(cell.x >> kBits, cell.y >> kBits, 0) != BlockIndex::kNone;
}

}  // namespace hulltrack
