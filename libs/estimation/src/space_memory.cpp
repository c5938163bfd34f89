// SPDX-License-Identifier: BSD-3-Clause
// Reduction of depth images, and the comparison of points with the depths and ranges measured in their
// directions.
#include "space_memory.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "visibility.h"

namespace roomgraph {
namespace {

constexpr int kColumns = 80;                            // of a reduced depth image
constexpr double kMoved_m = 0.15, kTurned_rad = 0.1;    // between two views
constexpr double kNearest_m = 0.4, kFarthest_m = 4.5;   // depths that are compared
constexpr double kMargin_m = 0.1, kMarginShare = 0.02;  // of range: noise of depth, pose and shape
constexpr double kEndedNear_m = 1;                      // before a point
constexpr double kMillimetre = 1e-3;
constexpr std::uint16_t kNearestDepth_mm = 1;

bool sameView(const Pose3& a, const Pose3& b) {
  const Pose3 moved = a.inverse() * b;
  return moved.translation().norm() < kMoved_m && rotationAngle(moved) < kTurned_rad;
}

// m, 0: none.
double depthAt(const cv::Mat& depth_mm, double u, double v) {
  const long x = std::lround(u), y = std::lround(v);
  if (x < 0 || y < 0 || x >= depth_mm.cols || y >= depth_mm.rows) return 0;
  return kMillimetre * depth_mm.at<std::uint16_t>(static_cast<int>(y), static_cast<int>(x));
}

// Who sits in a chair fills it, and walks off: as near as can be, they hide what is behind them.
void hideBehind(const std::vector<Box2>& people, double factor, cv::Mat& depth_mm) {
  for (const Box2& box : people) {
    const cv::Point first(static_cast<int>(box.u_min * factor), static_cast<int>(box.v_min * factor)),
        last(static_cast<int>(std::ceil(box.u_max * factor)), static_cast<int>(std::ceil(box.v_max * factor)));
    depth_mm(cv::Rect(first, last) & cv::Rect(0, 0, depth_mm.cols, depth_mm.rows)).setTo(kNearestDepth_mm);
  }
}

void count(RayCounts& counts, double measured_m, double range_m) {
  const double margin = kMargin_m + kMarginShare * range_m;
  if (measured_m > range_m + margin) {
    ++counts.crossed;
  } else if (measured_m >= range_m - margin) {
    ++counts.filled;
  } else {
    ++counts.hidden;
    counts.ended_near += measured_m > range_m - kEndedNear_m;
  }
}

}  // namespace

void SpaceMemory::add(const Frame& frame, const Pose3& world_from_robot, const std::vector<Box2>& people) {
  if (!frame.hasDepth() || !frame.camera.valid()) return;
  if (!images_.empty() && sameView(last_image_from_, world_from_robot)) return;
  last_image_from_ = world_from_robot;
  const double factor = std::min(1.0, static_cast<double>(kColumns) / frame.camera.width);
  const PinholeCamera camera = frame.camera.scaled(factor);
  cv::Mat depth_mm(camera.height, camera.width, CV_16UC1);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double z_m = frame.depthAt((u + 0.5) / factor - 0.5, (v + 0.5) / factor - 0.5);
      depth_mm.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(std::min(z_m / kMillimetre, 65535.0));
    }
  }
  hideBehind(people, factor, depth_mm);
  images_.push_back({frame.t, frame.robot_from_camera, camera, depth_mm});
}

void SpaceMemory::add(const Scan& scan, const Pose3& world_from_robot) {
  if (!scans_.empty() && sameView(last_scan_from_, world_from_robot)) return;
  last_scan_from_ = world_from_robot;
  scans_.push_back(std::make_shared<Scan>(scan));
}

void SpaceMemory::giveUpRepeated(std::size_t kept, const Trajectory& world_from_robot) {
  roomgraph::giveUpRepeated(images_, images_watch_, kept, world_from_robot, [](const Image& image) { return image.t; });
  roomgraph::giveUpRepeated(scans_, scans_watch_, kept, world_from_robot, [](const auto& scan) { return scan->t; });
}

PosedViews SpaceMemory::posed(const KeyPoses& poses) const {
  PosedViews out;
  if (poses.empty()) return out;
  for (const auto& image : images_)
    out.images_.push_back(
        {image.t, (poses.at(image.t) * image.robot_from_camera).inverse(), &image.camera, &image.depth_mm});
  for (const auto& scan : scans_) {
    const Pose3 world_from_lidar = poses.at(scan->t) * scan->robot_from_lidar;
    out.scans_.push_back({world_from_lidar.inverse(), world_from_lidar.translation().z(), scan.get()});
  }
  return out;
}

PosedViews PosedViews::between(double first, double last) const {
  const auto within = [=](double t) { return t >= first && t <= last; };
  PosedViews out;
  std::copy_if(images_.begin(), images_.end(), std::back_inserter(out.images_), [&](const Image& image) { return within(image.t); });
  std::copy_if(scans_.begin(), scans_.end(), std::back_inserter(out.scans_), [&](const Beams& beams) { return within(beams.scan->t); });
  return out;
}

std::vector<double> PosedViews::timesInGoodView(const Landmark& landmark) const {
  std::vector<double> out;
  for (const auto& image : images_) {
    const auto depth_at = [&image](double u, double v) { return depthAt(*image.depth_mm, u, v); };
    if (boxInGoodView(landmark, image.camera_from_world, *image.camera, depth_at)) out.push_back(image.t);
  }
  return out;
}

std::vector<RayCounts> PosedViews::byImages(const std::vector<Eigen::Vector3d>& points) const {
  std::vector<RayCounts> out(points.size());
  for (const auto& image : images_) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d p = image.camera_from_world * points[i];
      if (p.z() < kNearest_m || p.z() > kFarthest_m) continue;
      const Eigen::Vector2d pixel = image.camera->project(p);
      const double depth = depthAt(*image.depth_mm, pixel.x(), pixel.y());
      if (depth > 0) count(out[i], depth, p.z());
    }
  }
  return out;
}

std::vector<RayCounts> PosedViews::byScans(const std::vector<Eigen::Vector2d>& points, double least_z_m,
                                           double most_z_m) const {
  std::vector<RayCounts> out(points.size());
  for (const auto& [lidar_from_world, z_m, scan] : scans_) {
    if (z_m < least_z_m || z_m > most_z_m) continue;
    const auto beams = static_cast<long>(scan->ranges_m.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d p = (lidar_from_world * Eigen::Vector3d(points[i].x(), points[i].y(), z_m)).head<2>();
      const double range = p.norm();
      if (range < kNearest_m || !reaches(*scan, range)) continue;
      const double from_first = (std::atan2(p.y(), p.x()) - scan->angle_min_rad) / scan->angle_step_rad;
      const double turn = std::abs(2 * M_PI / scan->angle_step_rad);
      const long beam = std::lround(from_first - turn * std::floor(from_first / turn));
      if (beam < 0 || beam >= beams || !scan->valid[static_cast<std::size_t>(beam)]) continue;
      count(out[i], scan->ranges_m[static_cast<std::size_t>(beam)], range);
    }
  }
  return out;
}

}  // namespace roomgraph
