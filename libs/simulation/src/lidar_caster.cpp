// SPDX-License-Identifier: BSD-3-Clause
// Simulated lidar: exact ray casting on a horizontal cut of the scene, and measurement noise.
#include <cmath>
#include <limits>
#include <numbers>

#include "sensors.h"

namespace roomgraph {
namespace {


/// Cuts the part's triangles with the plane z = height.
void cut(const ScenePart& part, const Pose3& world_from_part, double height, std::vector<Segment>& out) {
  if (std::abs((world_from_part * part.center).z() - height) > part.radius) return;
  for (const auto& triangle : part.mesh.triangles) {
    Eigen::Vector3d corner[3];
    for (std::size_t i = 0; i < 3; ++i) corner[i] = world_from_part * triangle.position[i].cast<double>();
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < 3; ++i) {
      const auto &a = corner[i], &b = corner[(i + 1) % 3];
      if ((a.z() < height) == (b.z() < height)) continue;
      const double ratio = (height - a.z()) / (b.z() - a.z());
      points.emplace_back((a + ratio * (b - a)).head<2>());
    }
    if (points.size() == 2 && (points[0] - points[1]).norm() > 1e-9) out.push_back({points[0], points[1]});
  }
}

}  // namespace

LidarCaster::LidarCaster(const Scene& scene, double height_m) : scene_(scene), height_m_(height_m) {
  for (const auto& part : scene.parts())
    if (part.fixed) cut(part, Pose3::Identity(), height_m, fixed_);
}

std::vector<Segment> LidarCaster::furnishedOutlines(double seconds) const {
  std::vector<Segment> out = fixed_;
  const auto poses = scene_.partPoses(seconds);
  for (std::size_t i = 0; i < scene_.parts().size(); ++i) {
    const ScenePart& part = scene_.parts()[i];
    if (!part.fixed && part.person < 0) cut(part, poses[i], height_m_, out);
  }
  return out;
}

std::vector<double> LidarCaster::cast(const Pose2& world_from_lidar, int beams, double seconds) const {
  std::vector<Segment> moving;
  const auto poses = scene_.partPoses(seconds);
  for (std::size_t i = 0; i < scene_.parts().size(); ++i)
    if (!scene_.parts()[i].fixed) cut(scene_.parts()[i], poses[i], height_m_, moving);
  std::vector<double> out(static_cast<std::size_t>(beams), std::numeric_limits<double>::infinity());
  const Pose2 to_lidar = world_from_lidar.inverse();
  const double step = 2 * std::numbers::pi / (beams - 1);
  const auto add = [&](const Segment& segment) {
    const Eigen::Vector2d a = to_lidar * segment.a, b = to_lidar * segment.b, d = b - a;
    // Only the beams between the directions of the two ends can meet it.
    const double start = std::atan2(a.y(), a.x());
    const double span = wrapAngle(std::atan2(b.y(), b.x()) - start);
    const double low = std::min(start, start + span), high = std::max(start, start + span);
    for (const double turn : {-2 * std::numbers::pi, 0.0, 2 * std::numbers::pi}) {
      const int first = std::max(0, static_cast<int>(std::ceil((low + turn + std::numbers::pi) / step - 1e-9)));
      const int last = std::min(beams - 1, static_cast<int>(std::floor((high + turn + std::numbers::pi) / step + 1e-9)));
      for (int i = first; i <= last; ++i) {
        const double angle = -std::numbers::pi + i * step;
        const Eigen::Vector2d ray(std::cos(angle), std::sin(angle));
        const double across = ray.x() * d.y() - ray.y() * d.x();
        if (std::abs(across) < 1e-15) continue;
        const double range = (a.x() * d.y() - a.y() * d.x()) / across;
        if (range > 0) out[static_cast<std::size_t>(i)] = std::min(out[static_cast<std::size_t>(i)], range);
      }
    }
  };
  for (const auto& segment : fixed_) add(segment);
  for (const auto& segment : moving) add(segment);
  return out;
}

mrpt::obs::CObservation2DRangeScan measureScan(const std::vector<double>& distances, const LidarSpec& spec,
                                               Random random) {
  mrpt::obs::CObservation2DRangeScan out;
  out.aperture = static_cast<float>(2 * std::numbers::pi);
  out.rightToLeft = true;
  out.maxRange = static_cast<float>(spec.max_m);
  out.stdError = static_cast<float>(spec.sigma_m);
  out.sensorPose = toMrpt(poseFromYpr(spec.at_m.x(), spec.at_m.y(), spec.at_m.z(), 0, 0, 0));
  out.resizeScan(distances.size());
  for (std::size_t i = 0; i < distances.size(); ++i) {
    // Drawn for every beam, so that one beam's fate does not shift the others' noise.
    const double deviate = random.normal();
    const bool lost = random.chance(spec.dropouts);
    const double range = distances[i] + (spec.sigma_m + spec.sigma_relative * distances[i]) * deviate;
    const bool valid = std::isfinite(distances[i]) && !lost && range >= spec.min_m && range <= spec.max_m;
    out.setScanRange(i, valid ? static_cast<float>(range) : 0.f);
    out.setScanRangeValidity(i, valid);
  }
  return out;
}

}  // namespace roomgraph
