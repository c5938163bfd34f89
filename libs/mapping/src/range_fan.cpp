// SPDX-License-Identifier: BSD-3-Clause
// Beams from scans with free space limits, and virtual scans from depth images.
#include "roomgraph/mapping/range_fan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace roomgraph {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();

/// The three smallest values put in.
struct SmallestThree {
  std::array<float, 3> values{kNone, kNone, kNone};
  void put(float value) {
    if (value >= values[2]) return;
    values[2] = value;
    if (values[2] < values[1]) std::swap(values[1], values[2]);
    if (values[1] < values[0]) std::swap(values[0], values[1]);
  }
  bool full() const { return values[2] < kNone; }
};

struct Beam {
  SmallestThree obstacle, floor;  ///< ranges; floor: negated, so that the smallest is the farthest
  float range() const {
    if (obstacle.full()) return obstacle.values[2];
    return floor.full() ? floor.values[2] : 0.f;
  }
};

/// Sorts the image's points into beams over the full circle, beam 0 straight backwards.
std::vector<Beam> sortIntoBeams(const Frame& frame, const Pose3& ground_from_camera, const DepthSlice& slice,
                                const std::vector<Box2>& moving) {
  const auto moves = [&](int u, int v) {
    return std::any_of(moving.begin(), moving.end(), [&](const Box2& box) { return box.contains(u, v); });
  };
  std::vector<Beam> beams(static_cast<std::size_t>(std::ceil(2 * std::numbers::pi / slice.beam_rad)));
  for (int v = slice.step_px / 2; v < frame.depth.rows; v += slice.step_px) {
    const float* row = frame.depth.ptr<float>(v);
    for (int u = slice.step_px / 2; u < frame.depth.cols; u += slice.step_px) {
      if (!(row[u] > 0) || moves(u, v)) continue;
      const Eigen::Vector3d p =
          ground_from_camera * frame.camera.backProject(u, v, static_cast<double>(row[u]));
      const double range = std::hypot(p.x(), p.y());
      if (range > slice.max_range_m || std::abs(p.z()) > slice.max_height_m) continue;
      const double angle = std::atan2(p.y(), p.x()) + std::numbers::pi;
      Beam& beam = beams[std::min(static_cast<std::size_t>(angle / slice.beam_rad), beams.size() - 1)];
      if (p.z() >= slice.min_height_m)
        beam.obstacle.put(static_cast<float>(range));
      else if (p.z() > -slice.min_height_m)
        beam.floor.put(static_cast<float>(-range));
    }
  }
  return beams;
}

}  // namespace

RangeFan fanFromScan(const Scan& scan, double no_return_free_m) {
  RangeFan fan{scan.t, scan.robot_from_lidar, scan.angle_min_rad, scan.angle_step_rad, {}};
  const std::size_t count = scan.ranges_m.size();
  fan.ranges_m.resize(count, 0.f);
  const auto no_return = [&](std::size_t i) {
    return !scan.valid[i] && scan.max_range_m > 0 &&
           static_cast<double>(scan.ranges_m[i]) >= 0.999 * scan.max_range_m;
  };
  const auto free_m = static_cast<float>(std::min(no_return_free_m, scan.max_range_m));
  for (std::size_t i = 0; i < count; ++i) {
    if (scan.valid[i])
      fan.ranges_m[i] = scan.ranges_m[i];
    else if (i > 0 && i + 1 < count && no_return(i - 1) && no_return(i) && no_return(i + 1))
      fan.ranges_m[i] = -free_m;
  }
  return fan;
}

RangeFan fanFromDepth(const Frame& frame, const Plane& ground, const DepthSlice& slice,
                      const std::vector<Box2>& moving) {
  const Pose3 camera_from_ground = cameraFromGround(ground);
  const auto beams = sortIntoBeams(frame, camera_from_ground.inverse(), slice, moving);
  const auto known = [](const Beam& beam) { return beam.range() != 0; };
  const auto first = std::find_if(beams.begin(), beams.end(), known);
  const auto last = std::find_if(beams.rbegin(), beams.rend(), known).base();
  RangeFan fan{frame.t, frame.robot_from_camera * camera_from_ground, 0, slice.beam_rad, {}};
  fan.angle_min_rad = (static_cast<double>(first - beams.begin()) + 0.5) * slice.beam_rad - std::numbers::pi;
  for (auto beam = first; beam < last; ++beam) fan.ranges_m.push_back(beam->range());
  return fan;
}

}  // namespace roomgraph
