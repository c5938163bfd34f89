// SPDX-License-Identifier: BSD-3-Clause
// Nearest scan of an image, cells on its walls, and their means without outliers.
#include "wall_matches.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "roomgraph/core/order_statistics.h"
#include "sensor_model.h"

namespace roomgraph {
namespace {

constexpr double kLongestWait_s = 0.15;
constexpr double kViewMargin_s = 0.3;
constexpr double kSameHeight_m = 0.25;   // of heights around the lidar's
constexpr double kGatePerM2 = 0.004;     // by which gates are wider at depth z, times squared z
constexpr double kEnd_m = 0.05;          // of a wall's extent that is left out at each end
constexpr std::size_t kLeastCells = 12;  // of a match
constexpr double kTwoParts_m = 0.5;      // from which on a wall gives two matches
constexpr double kOutlierCell = 3;       // deviations

struct SeenCell {
  const DepthCell* cell;
  double off_m, along_m;
};

// Mean of cells on a wall.
struct WallPart {
  DepthPatch patch;
  double along_m = 0;
};

// Keeps the cells that are about as far off as the others.
std::optional<WallPart> meanOf(const std::vector<SeenCell>& cells) {
  if (cells.size() < kLeastCells) return std::nullopt;
  std::vector<double> off, deviations;
  for (const auto& cell : cells) off.push_back(cell.off_m);
  const double middle = median(off);
  for (const double value : off) deviations.push_back(std::abs(value - middle));
  const double most = std::max(0.01, kOutlierCell * 1.4826 * median(deviations));
  WallPart out;
  double count = 0;
  for (const auto& cell : cells) {
    if (std::abs(cell.off_m - middle) > most) continue;
    out.patch.point += cell.cell->patch.point;
    out.patch.ray += cell.cell->patch.ray;
    out.along_m += cell.along_m;
    ++count;
  }
  if (count < static_cast<double>(kLeastCells)) return std::nullopt;
  out.patch.point /= count;
  out.patch.ray /= count;
  out.along_m /= count;
  return out;
}

std::vector<WallPart> partsOf(std::vector<SeenCell> cells) {
  std::vector<WallPart> out;
  if (cells.empty()) return out;
  std::sort(cells.begin(), cells.end(), [](const auto& a, const auto& b) { return a.along_m < b.along_m; });
  const double length = cells.back().along_m - cells.front().along_m;
  const auto middle = cells.begin() + static_cast<std::ptrdiff_t>(cells.size() / 2);
  const bool halves = length >= kTwoParts_m;
  for (const auto& part :
       halves ? std::vector<std::vector<SeenCell>>{{cells.begin(), middle}, {middle, cells.end()}}
              : std::vector<std::vector<SeenCell>>{cells})
    if (const auto mean = meanOf(part)) out.push_back(*mean);
  return out;
}

const WallScan* nearestScan(const std::vector<WallScan>& scans, double t) {
  const auto after = std::lower_bound(scans.begin(), scans.end(), t,
                                      [](const WallScan& scan, double at) { return scan.t < at; });
  const WallScan* best = nullptr;
  for (auto it = after == scans.begin() ? after : after - 1; it != scans.end() && it <= after; ++it)
    if (std::abs(it->t - t) < kLongestWait_s && (!best || std::abs(it->t - t) < std::abs(best->t - t)))
      best = &*it;
  return best;
}

struct Placed {
  Eigen::Vector2d point, normal;
  double height_m;
};

// A cell in the lidar's horizontal frame at the time of the scan.
Placed place(const DepthCell& cell, const double* p, const PlanarValues<double>& scan_from_view) {
  const Eigen::Vector3d on_robot = patchOnRobot(p, cell.patch);
  const Eigen::Vector3d normal = cameraRotation(p) * cell.normal;
  const Eigen::Rotation2Dd turn(scan_from_view[2]), to_lidar(-p[kLidarYaw]);
  const Eigen::Vector2d in_view = inLidar(p, on_robot);
  return {turn * in_view + Eigen::Vector2d(scan_from_view[0], scan_from_view[1]),
          turn * (to_lidar * Eigen::Vector2d(normal.head<2>())).normalized(), on_robot.z()};
}

void matchView(const DepthView& view, const WallScan& scan, const PlanarValues<double>& scan_from_view,
               const double* p, double lidar_z_m, const MatchGate& gate, std::vector<WallMatch>& out) {
  const double least_cosine = std::cos(gate.angle_rad);
  std::vector<std::vector<SeenCell>> of_wall(scan.walls.size());
  for (const DepthCell& cell : view.upright) {
    const Placed placed = place(cell, p, scan_from_view);
    if (std::abs(placed.height_m - lidar_z_m) > kSameHeight_m) continue;
    std::optional<std::size_t> best;
    const double z = cell.patch.point.z();
    SeenCell seen{&cell, gate.distance_m + kGatePerM2 * z * z, 0};
    for (std::size_t i = 0; i < scan.walls.size(); ++i) {
      const ScanWall& wall = scan.walls[i];
      const double off = wall.normal.dot(placed.point) - wall.distance_m,
                   along = wall.along.dot(placed.point);
      if (std::abs(off) >= std::abs(seen.off_m) || along < wall.from_m + kEnd_m ||
          along > wall.to_m - kEnd_m || wall.normal.dot(placed.normal) < least_cosine)
        continue;
      seen.off_m = off;
      seen.along_m = along;
      best = i;
    }
    if (best) of_wall[*best].push_back(seen);
  }
  for (std::size_t i = 0; i < of_wall.size(); ++i)
    for (const WallPart& part : partsOf(of_wall[i]))
      out.push_back({0, scan.t, view.t, scan.walls[i], scan.walls[i].sigmaAt(part.along_m), part.patch});
}

}  // namespace

std::vector<WallMatch> matchWalls(const RecordingEvidence& evidence, const ParameterVector& parameters,
                                  double lidar_z_m, const MatchGate& gate) {
  std::vector<WallMatch> out;
  for (const DepthView& view : evidence.views) {
    const double t = view.t + parameters[kCameraTime];
    const WallScan* scan = nearestScan(evidence.scans, t);
    const PlanarPath* path = scan ? pathAt(evidence.lidar, t, kViewMargin_s) : nullptr;
    if (!path || !path->covers(scan->t, 0)) continue;
    const std::size_t before = out.size();
    matchView(view, *scan, planarBetween(path->at(scan->t), path->at(t)), parameters.data(), lidar_z_m, gate,
              out);
    for (std::size_t i = before; i < out.size(); ++i)
      out[i].path = static_cast<std::size_t>(path - evidence.lidar.data());
  }
  return out;
}

}  // namespace roomgraph
