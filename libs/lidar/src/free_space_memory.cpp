// SPDX-License-Identifier: BSD-3-Clause
// Rolling grid of free space: test of returns against it, and its update by hits, surfaces and beams.
#include "roomgraph/lidar/free_space_memory.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

constexpr double kLongestStep_s = 0.5;    // a scan speaks for no longer than this
constexpr double kImplausible_s = 1;      // then the memory is wrong, not the poses
constexpr double kLevelCosine = 0.99619;  // 5 degrees
constexpr double kSamePlane_m = 0.05;     // scans at different heights see different things
constexpr double kSurfaceGap_m = 1;       // neighbouring returns nearer than this may lie on one surface
constexpr float kEdgeFactor = 2.5F;       // next to what is not free, a return soon counts as static
constexpr float kHeldAgainst_s = 3;       // a return outweighs beams of this time; thin things are seldom hit
constexpr float kForgetPerSecond = 0.1F;  // of contradiction, while beams go through again
constexpr double kPersonGap_m = 0.2;      // between returns of one thing
constexpr double kFarthest_m = 1e6;       // numbers of cells must fit an int
constexpr int kFewestToJudge = 10;        // of fewer, a share says nothing

/// Visits the cells that the segment crosses, from its first to before its last. J. Amanatides and A. Woo, "A
/// fast voxel traversal algorithm for ray tracing", 1987. In units of cells.
template <class Visit>
void crossCells(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Visit visit) {
  Eigen::Vector2i cell = from.array().floor().cast<int>();
  const Eigen::Vector2i last = to.array().floor().cast<int>();
  const Eigen::Vector2d way = to - from;
  Eigen::Vector2i step;
  Eigen::Vector2d next, delta;  // as shares of the segment
  for (int k = 0; k < 2; ++k) {
    step[k] = way[k] >= 0 ? 1 : -1;
    delta[k] = 1 / std::max(1e-12, std::abs(way[k]));
    next[k] = (way[k] >= 0 ? cell[k] + 1 - from[k] : from[k] - cell[k]) * delta[k];
  }
  double next_x = next.x(), next_y = next.y();  // scalars: this loop takes most of a scan's time
  const double delta_x = delta.x(), delta_y = delta.y();
  int x = cell.x(), y = cell.y();
  for (int left = (last - cell).cwiseAbs().sum(); left > 0; --left) {
    visit(x, y);
    if (next_x < next_y)
      x += step.x(), next_x += delta_x;
    else
      y += step.y(), next_y += delta_y;
  }
}

}  // namespace

void FreeSpaceOptions::declare(ParameterVisitor& v) {
  v.add(
      "leave_out_moving", enabled,
      {.doc =
           "Whether returns in space that earlier beams went through are taken as on people and left out."});
  v.add(
      "free_cell_m", cell_m,
      {.doc = "Cell size of the memory of free space around the robot.", .unit = "m", .min = 0.05, .max = 1});
  v.add("free_reach_m", reach_m,
        {.doc = "Distance up to which space is kept in mind as free.", .unit = "m", .min = 1, .max = 30});
  v.add("free_after_s", free_after_s,
        {.doc = "Space is free when beams have gone through for this time.",
         .unit = "s",
         .min = 0.1,
         .max = 100});
  v.add("settle_s", settle_s,
        {.doc = "What stays in free space for this time is no longer taken as moving.",
         .unit = "s",
         .min = 0,
         .max = 1000});
  v.add("free_memory_s", memory_s,
        {.doc = "Free space is forgotten when no beam has gone through for this time.",
         .unit = "s",
         .min = 0.1,
         .max = 1000});
  v.add("least_moving_width_m", least_width_m,
        {.doc = "Narrower things, such as legs of furniture, are not taken as moving.",
         .unit = "m",
         .min = 0,
         .max = 1});
  v.add("max_moving_share", max_share,
        {.doc = "When a larger share of the returns contradicts free space, the pose is wrong and none is "
                "left out.",
         .min = 0,
         .max = 1});
}

FreeSpaceMemory::FreeSpaceMemory(const FreeSpaceOptions& options) : options_(options) {
  const double across = 2 * (options.reach_m / options.cell_m + 2);
  for (side_ = 1; side_ < across;) side_ *= 2;
  clear();
}

void FreeSpaceMemory::clear() {
  cells_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), Cell());
  scan_ = 0;
  implausible_s_ = 0;
}

std::vector<std::size_t> FreeSpaceMemory::observe(const Scan& scan, const Pose2& odom_from_robot,
                                                  double min_range_m, const std::vector<float>& free_m) {
  const Eigen::Vector3d mount = scan.robot_from_lidar.translation();
  if (std::abs(scan.robot_from_lidar.linear()(2, 2)) < kLevelCosine) return {};
  if (scan_ > 0 && std::abs(mount.z() - height_m_) > kSamePlane_m) return {};
  if (scan_ > 0 && scan.t <= last_t_) return {};
  if (scan_ == 0) first_t_ = last_t_ = scan.t, height_m_ = mount.z();
  now_s_ = static_cast<float>(scan.t - first_t_);
  step_s_ = static_cast<float>(std::min(kLongestStep_s, scan.t - last_t_));
  last_t_ = scan.t;
  ++scan_;
  origin_ = odom_from_robot * Eigen::Vector2d(mount.head<2>());
  if (!(origin_.cwiseAbs().maxCoeff() < kFarthest_m)) return {};
  roll(cellOf(origin_));

  std::vector<Return> returns = returnsOf(scan, odom_from_robot, min_range_m, free_m);
  dropThin(returns, std::abs(scan.angle_step_rad));
  std::vector<std::size_t> moving;
  for (const Return& r : returns)
    if (r.moving) moving.push_back(r.beam);
  const auto most =
      options_.max_share * static_cast<double>(std::max<std::size_t>(kFewestToJudge, returns.size()));
  if (static_cast<double>(moving.size()) > most) {
    implausible_s_ += static_cast<double>(step_s_);
    if (implausible_s_ >= kImplausible_s) clear();
    return {};
  }
  implausible_s_ = 0;
  hit(returns);
  keepSurfaces(returns);
  pass(returns, std::abs(scan.angle_step_rad));
  return moving;
}

FreeSpaceMemory::Cell& FreeSpaceMemory::at(const Eigen::Vector2i& cell) {
  const int wrap = side_ - 1;
  return cells_[static_cast<std::size_t>(cell.y() & wrap) * static_cast<std::size_t>(side_) +
                static_cast<std::size_t>(cell.x() & wrap)];
}

Eigen::Vector2i FreeSpaceMemory::cellOf(const Eigen::Vector2d& point) const {
  return (point / options_.cell_m).array().floor().cast<int>();
}

bool FreeSpaceMemory::isFree(const Cell& cell) const {
  return cell.free_s >= static_cast<float>(options_.free_after_s) &&
         now_s_ - cell.passed_s <= static_cast<float>(options_.memory_s);
}

bool FreeSpaceMemory::isFreeAround(const Eigen::Vector2i& cell) {
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      if (!isFree(at(cell + Eigen::Vector2i(x, y)))) return false;
  return true;
}

// Cells that leave the grid on one side come in on the other, unknown.
void FreeSpaceMemory::roll(const Eigen::Vector2i& center) {
  const Eigen::Vector2i before = center_, moved = center - before;
  center_ = center;
  if (moved.cwiseAbs().maxCoeff() >= side_) {
    std::fill(cells_.begin(), cells_.end(), Cell());
    return;
  }
  const int half = side_ / 2;
  for (int axis = 0; axis < 2; ++axis) {
    const int direction = moved[axis] > 0 ? 1 : -1;
    for (int i = 0; i < std::abs(moved[axis]); ++i) {
      // The line that comes in: at +half - 1 on the way up, at -half on the way down.
      const int line = before[axis] + direction * (i + 1) + (direction > 0 ? half - 1 : -half);
      for (int other = 0; other < side_; ++other)
        at(axis == 0 ? Eigen::Vector2i(line, other) : Eigen::Vector2i(other, line)) = Cell();
    }
  }
}

std::vector<FreeSpaceMemory::Return> FreeSpaceMemory::returnsOf(const Scan& scan,
                                                                const Pose2& odom_from_robot,
                                                                double min_range_m,
                                                                const std::vector<float>& free_m) {
  std::vector<Return> out;
  out.reserve(scan.ranges_m.size());
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const bool is_hit = scan.valid[i] != 0;
    const auto range = static_cast<double>(is_hit || free_m.empty() ? scan.ranges_m[i] : free_m[i]);
    if ((!is_hit && (free_m.empty() || range <= 0)) || !(range >= min_range_m) || !std::isfinite(range)) continue;
    const double angle = scan.angle_min_rad + static_cast<double>(i) * scan.angle_step_rad;
    const Eigen::Vector3d in_lidar(range * std::cos(angle), range * std::sin(angle), 0);
    const Eigen::Vector2d point =
        odom_from_robot * Eigen::Vector2d((scan.robot_from_lidar * in_lidar).head<2>());
    out.push_back({i, point, is_hit && range <= options_.reach_m && isFreeAround(cellOf(point)), is_hit});
  }
  return out;
}

// Legs of furniture are thin: beams pass by on both sides, and from elsewhere one hits.
void FreeSpaceMemory::dropThin(std::vector<Return>& returns, double beam_step_rad) const {
  for (std::size_t first = 0, end = 0; first < returns.size(); first = end) {
    end = first + 1;
    if (!returns[first].moving) continue;
    while (end < returns.size() && returns[end].moving && returns[end].beam <= returns[end - 1].beam + 2 &&
           (returns[end].point - returns[end - 1].point).norm() < kPersonGap_m)
      ++end;
    const double between_beams = (returns[first].point - origin_).norm() * beam_step_rad;
    const double width = (returns[end - 1].point - returns[first].point).norm() + between_beams;
    if (width >= options_.least_width_m) continue;
    for (std::size_t i = first; i < end; ++i) returns[i].moving = false;
  }
}

// Until a cell is free any return in it starts the count again, from below; a free one has to be contradicted
// for a while, so that somebody who walks through leaves it free.
void FreeSpaceMemory::hit(const std::vector<Return>& returns) {
  for (const Return& r : returns) {
    if (!r.is_hit || (r.point - origin_).squaredNorm() > options_.reach_m * options_.reach_m) continue;
    Cell& cell = at(cellOf(r.point));
    if (cell.scan == scan_) continue;
    cell.scan = scan_;
    cell.contradicted_s += step_s_ * (r.moving ? 1.F : kEdgeFactor);
    if (!isFree(cell) || cell.contradicted_s >= static_cast<float>(options_.settle_s))
      cell.free_s = -kHeldAgainst_s, cell.contradicted_s = 0;
  }
}

// A beam that grazes a wall crosses cells that hold the wall between two of its returns: that says nothing.
void FreeSpaceMemory::keepSurfaces(const std::vector<Return>& returns) {
  for (std::size_t i = 1; i < returns.size(); ++i) {
    const Return &a = returns[i - 1], &b = returns[i];
    if (!a.is_hit || !b.is_hit || b.beam != a.beam + 1 || (b.point - a.point).norm() > kSurfaceGap_m) continue;
    if ((a.point - origin_).norm() > options_.reach_m || (b.point - origin_).norm() > options_.reach_m)
      continue;
    crossCells(a.point / options_.cell_m, b.point / options_.cell_m, [&](int x, int y) {
      at({x, y}).scan = scan_;
    });
  }
}

void FreeSpaceMemory::pass(Cell& cell) {
  cell.scan = scan_;
  if (now_s_ - cell.passed_s > static_cast<float>(options_.memory_s)) cell.free_s = cell.contradicted_s = 0;
  cell.passed_s = now_s_;
  cell.free_s = std::min(static_cast<float>(options_.free_after_s), cell.free_s + step_s_);
  cell.contradicted_s = std::max(0.F, cell.contradicted_s - kForgetPerSecond * step_s_);
}

// As far as neighbouring beams are closer than a cell: farther on, something in a cell may lie between them.
void FreeSpaceMemory::pass(const std::vector<Return>& returns, double beam_step_rad) {
  const double reach =
      beam_step_rad > 0 ? std::min(options_.reach_m, options_.cell_m / beam_step_rad) : options_.reach_m;
  const std::uint32_t scan = scan_;
  for (const Return& r : returns) {
    const Eigen::Vector2d ray = r.point - origin_;
    const Eigen::Vector2d end = origin_ + ray * std::min(1.0, reach / std::max(1e-9, ray.norm()));
    crossCells(origin_ / options_.cell_m, end / options_.cell_m, [&](int x, int y) {
      Cell& cell = at({x, y});
      if (cell.scan != scan) pass(cell);
    });
  }
}

}  // namespace roomgraph
