// SPDX-License-Identifier: BSD-3-Clause
// Blocks of depth pixels, their surface normals, and patches of floor.
#include "depth_view.h"

#include <array>
#include <cmath>
#include <utility>

#include "roomgraph/core/order_statistics.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

constexpr int kBlocksAcross = 80;
constexpr double kLeastValid = 0.6;                  // share of a block's pixels
constexpr double kEdge_m = 0.03, kEdgeShare = 0.12;  // spread of depth within a block, and share of its depth
constexpr double kFloorThick_m = 0.02, kFloorThickPerM = 0.003;  // the latter times squared depth
constexpr double kFarthestFloor_m = 4.2;
const double kFloorFacing =
    std::cos(15 * kDegree);  // of its normal: feet of walls and furniture are no floor
constexpr double kBent_m = 0.02, kBentPerM2 = 0.01;  // of a surface, between blocks at both sides of one
constexpr double kMostSlope = 0.4;                   // of the normal of an upright surface
constexpr std::size_t kLeastBlocks = 15;
constexpr int kColumns = 3, kBands = 3;
constexpr std::array<double, kBands - 1> kBandEnds_m{1.5, 2.5};

struct Block {
  DepthPatch patch;
  double spread_m = 0;
  bool valid = false;
};

struct BlockGrid {
  int columns = 0, rows = 0;
  std::vector<Block> blocks;

  const Block& at(int column, int row) const {
    return blocks[static_cast<std::size_t>(row * columns + column)];
  }
};

Block blockOf(const Frame& frame, int u0, int v0, int size) {
  Block out;
  double nearest = 1e9, farthest = 0;
  int valid = 0;
  for (int v = v0; v < v0 + size; ++v)
    for (int u = u0; u < u0 + size; ++u) {
      const double z = frame.depth.at<float>(v, u);
      if (!(z > 0)) continue;
      const Eigen::Vector3d ray = frame.camera.ray(u, v);
      out.patch.point += z * ray;
      out.patch.ray += ray;
      nearest = std::min(nearest, z);
      farthest = std::max(farthest, z);
      ++valid;
    }
  out.valid = valid >= kLeastValid * size * size;
  if (!out.valid) return out;
  out.patch.point /= valid;
  out.patch.ray /= valid;
  out.spread_m = farthest - nearest;
  return out;
}

BlockGrid blocksOf(const Frame& frame) {
  const int size = std::max(2, frame.depth.cols / kBlocksAcross);
  BlockGrid grid{frame.depth.cols / size, frame.depth.rows / size, {}};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      grid.blocks.push_back(blockOf(frame, column * size, row * size, size));
  return grid;
}

bool isWhole(const Block& block) {
  return block.valid && block.spread_m < kEdge_m + kEdgeShare * block.patch.point.z();
}

std::optional<Eigen::Vector3d> normalAt(const BlockGrid& grid, int column, int row) {
  if (column < 1 || row < 1 || column + 1 >= grid.columns || row + 1 >= grid.rows) return std::nullopt;
  const Block &left = grid.at(column - 1, row), &right = grid.at(column + 1, row),
              &above = grid.at(column, row - 1), &below = grid.at(column, row + 1);
  for (const Block* block : {&left, &right, &above, &below})
    if (!isWhole(*block)) return std::nullopt;
  const Eigen::Vector3d& middle = grid.at(column, row).patch.point;
  const double most_off = kBent_m + kBentPerM2 * middle.z() * middle.z();
  for (const auto& [a, b] : {std::pair(&left, &right), std::pair(&above, &below)})
    if (((a->patch.point + b->patch.point) / 2 - middle).norm() > most_off) return std::nullopt;
  const Eigen::Vector3d normal =
      (right.patch.point - left.patch.point).cross(below.patch.point - above.patch.point).normalized();
  return normal.dot(grid.at(column, row).patch.point) > 0 ? Eigen::Vector3d(-normal) : normal;
}

// Near and far, left and right apart: what tells tilt, height and bias of depth from each other.
std::vector<DepthPatch> floorPatches(const BlockGrid& grid, const Plane& floor) {
  std::array<DepthPatch, kColumns * kBands> sums;
  std::array<std::size_t, kColumns * kBands> counts{};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const Block& block = grid.at(column, row);
      const double z = block.patch.point.z();
      if (!block.valid || z > kFarthestFloor_m ||
          std::abs(floor.distance(block.patch.point)) > kFloorThick_m + kFloorThickPerM * z * z)
        continue;
      const auto normal = normalAt(grid, column, row);
      if (!normal || normal->dot(floor.normal) < kFloorFacing) continue;
      int band = 0;
      for (const double end : kBandEnds_m) band += z > end;
      const auto i = static_cast<std::size_t>(band * kColumns + column * kColumns / grid.columns);
      sums[i].point += block.patch.point;
      sums[i].ray += block.patch.ray;
      ++counts[i];
    }
  std::vector<DepthPatch> out;
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (const auto n = static_cast<double>(counts[i]); counts[i] >= kLeastBlocks)
      out.push_back({sums[i].point / n, sums[i].ray / n});
  return out;
}

}  // namespace

DepthView makeDepthView(const Frame& frame, const std::optional<Plane>& floor,
                        const std::optional<HeightBand>& band) {
  const BlockGrid grid = blocksOf(frame);
  DepthView out;
  out.t = frame.t;
  if (floor) out.floor = floorPatches(grid, *floor);
  if (!band) return out;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const Block& block = grid.at(column, row);
      if (!isWhole(block)) continue;
      const double height = (frame.robot_from_camera * block.patch.point).z();
      if (height < band->low_m || height > band->high_m) continue;
      const auto normal = normalAt(grid, column, row);
      if (normal && std::abs((frame.robot_from_camera.linear() * *normal).z()) < kMostSlope)
        out.upright.push_back({block.patch, *normal});
    }
  return out;
}

std::optional<double> medianDepth(const Frame& frame) {
  constexpr int kStep_px = 16;
  std::vector<double> depths;
  for (int v = 0; v < frame.depth.rows; v += kStep_px)
    for (int u = 0; u < frame.depth.cols; u += kStep_px)
      if (const float z = frame.depth.at<float>(v, u); z > 0) depths.push_back(z);
  if (depths.size() < 20) return std::nullopt;
  return median(depths);
}

}  // namespace roomgraph
