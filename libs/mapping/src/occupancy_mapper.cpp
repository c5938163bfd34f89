// SPDX-License-Identifier: BSD-3-Clause
// Choice of beams to insert, size of the grid, and insertion of beams along the trajectory.
#include "roomgraph/mapping/occupancy_mapper.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "ray_grid.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

constexpr double kPoseHorizon_s = 0.1;  ///< a scan's stamp may be this far outside the trajectory's time span
constexpr double kNearScan_s = 5;  // a lidar that says nothing for longer leaves the grid to depth images
constexpr double kMargin_m = 0.5;       ///< unknown border around everything seen
constexpr double kMaxCells = 4e8;       ///< 1 km x 1 km at 0.05 m

/// Beams of one fan in world, cut at `max_range_m`: a return beyond it only makes the way there free.
std::vector<Ray> raysInWorld(const RangeFan& fan, const Pose3& world_from_fan, double max_range_m) {
  std::vector<Ray> rays;
  rays.reserve(fan.ranges_m.size());
  for (std::size_t i = 0; i < fan.ranges_m.size(); ++i) {
    const double range = static_cast<double>(fan.ranges_m[i]);
    if (range == 0) continue;
    const double angle = fan.angle_min_rad + static_cast<double>(i) * fan.angle_step_rad;
    const double length = std::min(std::abs(range), max_range_m);
    const Eigen::Vector3d end =
        world_from_fan * Eigen::Vector3d(length * std::cos(angle), length * std::sin(angle), 0);
    rays.push_back({end.head<2>(), range > 0 && range <= max_range_m});
  }
  return rays;
}

mrpt::maps::COccupancyGridMap2D::Ptr emptyGrid(const Eigen::AlignedBox2d& area, double resolution_m) {
  const Eigen::Vector2d size = area.sizes() / resolution_m;
  if (!(size.x() * size.y() < kMaxCells)) {
    std::ostringstream what;
    what << "occupancy grid: the poses spread over " << area.sizes().x() << " x " << area.sizes().y()
         << " m, too large for cells of " << resolution_m << " m";
    throw RunError(what.str());
  }
  auto grid = mrpt::maps::COccupancyGridMap2D::Create();
  grid->setSize(static_cast<float>(area.min().x()), static_cast<float>(area.max().x()),
                static_cast<float>(area.min().y()), static_cast<float>(area.max().y()),
                static_cast<float>(resolution_m));
  return grid;
}

/// The area, and that of the grid, in whole cells of the grid.
Eigen::AlignedBox2d onLatticeOf(const mrpt::maps::COccupancyGridMap2D& grid,
                                const Eigen::AlignedBox2d& area) {
  const double cell = static_cast<double>(grid.getResolution());
  const Eigen::Vector2d low(static_cast<double>(grid.getXMin()), static_cast<double>(grid.getYMin()));
  const Eigen::Vector2d high(static_cast<double>(grid.getXMax()), static_cast<double>(grid.getYMax()));
  const Eigen::Array2d before = ((low - area.min()).array() / cell).ceil().max(0.0);
  const Eigen::Array2d after = ((area.max() - high).array() / cell).ceil().max(0.0);
  return {(low.array() - cell * before).matrix(), (high.array() + cell * after).matrix()};
}

/// A larger grid on the lattice of this one, with its cells.
mrpt::maps::COccupancyGridMap2D::Ptr grown(const mrpt::maps::COccupancyGridMap2D& grid,
                                           const Eigen::AlignedBox2d& area) {
  const double cell = static_cast<double>(grid.getResolution());
  auto out = emptyGrid(onLatticeOf(grid, area), cell);
  const auto offset = [cell](float from, float to) {
    return std::lround((static_cast<double>(to) - static_cast<double>(from)) / cell);
  };
  const auto x0 = offset(out->getXMin(), grid.getXMin()), y0 = offset(out->getYMin(), grid.getYMin());
  for (int y = 0; y < static_cast<int>(grid.getSizeY()); ++y)
    std::copy_n(grid.getRow(y), grid.getSizeX(), out->getRow(y + static_cast<int>(y0)) + x0);
  return out;
}

}  // namespace

// The rays of all fans together would take more memory than all else of the map: they are made when they are needed.
struct OccupancyMapper::PosedFan {
  const RangeFan* fan;
  Pose3 world_from_fan;
  Eigen::Vector2d origin() const { return world_from_fan.translation().head<2>(); }
  std::vector<Ray> rays(double max_range_m) const { return raysInWorld(*fan, world_from_fan, max_range_m); }
};

void OccupancyMapper::add(const Scan& scan) {
  scans_.push_back(fanFromScan(scan, options_.no_return_free_m));
  if (scanned_.empty() || scan.t > scanned_.back().second + 2 * kNearScan_s) scanned_.emplace_back(scan.t, scan.t);
  scanned_.back().second = std::max(scanned_.back().second, scan.t);
}

void OccupancyMapper::add(const Frame& frame, const Plane& ground, const std::vector<Box2>& moving) {
  if (auto of_frame = slice(frame, ground, moving)) add(std::move(*of_frame));
}

std::optional<RangeFan> OccupancyMapper::slice(const Frame& frame, const Plane& ground, const std::vector<Box2>& moving) const {
  if (!frame.hasDepth() || !frame.camera.valid()) return std::nullopt;
  return fanFromDepth(frame, ground, options_.slice, moving);
}

bool OccupancyMapper::drawsDepth(double t) const {
  return options_.source == "depth" || options_.source == "both" || (options_.source == "auto" && isFarFromScans(t));
}

bool OccupancyMapper::isFarFromScans(double t) const {
  return std::none_of(scanned_.begin(), scanned_.end(), [t](const auto& span) {
    return t > span.first - kNearScan_s && t < span.second + kNearScan_s;
  });
}

void OccupancyMapper::giveUpRepeated(std::size_t kept, const Trajectory& world_from_robot) {
  const auto time = [](const RangeFan& fan) { return fan.t; };
  roomgraph::giveUpRepeated(scans_, scans_watch_, kept, world_from_robot, time);
  roomgraph::giveUpRepeated(slices_, slices_watch_, kept, world_from_robot, time);
}

void OccupancyMapper::select(const std::vector<RangeFan>& fans, const Trajectory& world_from_robot,
                             std::vector<PosedFan>& out) const {
  std::optional<StampedPose> last;
  for (const auto& fan : fans) {
    if (&fans == &slices_ && !drawsDepth(fan.t)) continue;
    const auto pose = world_from_robot.at(fan.t, kPoseHorizon_s);
    if (!pose) continue;
    if (last) {
      const Pose3 movement = last->pose.inverse() * *pose;
      if (movement.translation().norm() < options_.min_move_m &&
          rotationAngle(movement) < options_.min_turn_rad && std::abs(fan.t - last->t) < options_.max_wait_s)
        continue;
    }
    last = StampedPose{fan.t, *pose};
    out.push_back({&fan, *pose * fan.robot_from_fan});
  }
}

mrpt::maps::COccupancyGridMap2D::Ptr OccupancyMapper::build(
    const Trajectory& world_from_robot, const mrpt::maps::COccupancyGridMap2D* earlier) const {
  const std::string& source = options_.source;
  const bool use_scans = source == "lidar" || source == "both" || (source == "auto" && !scans_.empty());
  std::vector<PosedFan> posed;
  if (use_scans) select(scans_, world_from_robot, posed);
  select(slices_, world_from_robot, posed);
  Eigen::AlignedBox2d area;
  for (const auto& fan : posed) {
    area.extend(fan.origin());
    for (const auto& ray : fan.rays(options_.max_range_m)) area.extend(ray.end);
  }
  if (area.isEmpty()) return earlier ? mrpt::maps::COccupancyGridMap2D::Create(*earlier) : nullptr;
  area.min().array() -= kMargin_m;
  area.max().array() += kMargin_m;
  auto grid = earlier ? grown(*earlier, area) : emptyGrid(area, options_.resolution_m);
  RayGrid rays(*grid, options_.hit_probability, options_.pass_probability);
  for (const auto& fan : posed) rays.insert(fan.origin(), fan.rays(options_.max_range_m));
  return grid;
}

}  // namespace roomgraph
