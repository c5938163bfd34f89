// SPDX-License-Identifier: BSD-3-Clause
// Path of the robot as a ribbon coloured by time.
#include <algorithm>
#include <cmath>

#include "roomgraph/rendering/scene_parts.h"
#include "roomgraph/rendering/triangle_set.h"

namespace roomgraph {
namespace {

constexpr double kPathLift = 0.02;  ///< above the floor and its grid
constexpr double kGap_m = 1;  ///< nothing is drawn across: between two sessions, or where the robot was lost

/// Poses at least `spacing` apart; a robot moves on the floor, a handheld camera where it was.
std::vector<StampedPose> thinned(const CSemanticMap& map, double spacing) {
  std::vector<StampedPose> kept;
  for (const auto& stamped : map.world_from_robot)
    if (kept.empty() || (stamped.pose.translation() - kept.back().pose.translation()).norm() >= spacing)
      kept.push_back(stamped);
  return kept;
}

}  // namespace

void addPath(const CSemanticMap& map, mrpt::opengl::COpenGLScene& scene, std::optional<double> line_width) {
  if (map.world_from_robot.empty()) return;
  const double width = line_width ? *line_width : lineWidth(map);
  const auto place = [&](const Pose3& pose, double lift) {
    Eigen::Vector3d p = pose.translation();
    if (map.planar) p.z() = 0;
    p.z() += lift;
    return p;
  };
  const auto poses = thinned(map, 1.5 * width);
  const double begin = map.world_from_robot.front().t;
  const double span = std::max(map.world_from_robot.back().t - begin, 1e-9);
  TriangleSet mesh;
  // Later parts lie a little higher: where the path covers itself, the newest shows.
  const auto lift_at = [&](double t) { return kPathLift + 0.008 * (t - begin) / span; };
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const auto color = palette::mix(palette::kPathStart, palette::kPathEnd, (poses[i].t - begin) / span);
    const Eigen::Vector3d to = place(poses[i].pose, lift_at(poses[i].t));
    const Eigen::Vector3d from = place(poses[i - 1].pose, lift_at(poses[i - 1].t));
    if ((to - from).norm() < kGap_m) mesh.ribbon(from, to, width, color);
    mesh.disc(to, width / 2, color, 8);
  }
  const Eigen::Vector3d start = place(map.world_from_robot.front().pose, kPathLift + 0.01);
  mesh.disc(start, 2.8 * width, palette::kPathEnd, 24);
  mesh.disc(start + Eigen::Vector3d(0, 0, 0.004), 1.9 * width, palette::kFree, 24);

  const StampedPose& last = map.world_from_robot.back();
  const double size = std::max(4.5 * width, 0.12);
  const Eigen::Vector3d tip = place(last.pose, kPathLift + 0.01);
  // A camera's own x axis points to its right, but trajectories are of the robot's body: x forward.
  const double yaw = planarPart(last.pose).yaw;
  const auto arrow = [&](double scale, double lift) {
    const auto at = [&](double forward, double left) {
      return Eigen::Vector3d(tip.x() + scale * size * (forward * std::cos(yaw) - left * std::sin(yaw)),
                             tip.y() + scale * size * (forward * std::sin(yaw) + left * std::cos(yaw)),
                             tip.z() + lift);
    };
    return std::vector{at(1.2, 0), at(-0.9, 0.85), at(-0.9, -0.85)};
  };
  mesh.polygon(arrow(1.35, 0), palette::kFree);
  mesh.polygon(arrow(1, 0.004), palette::kPathEnd);
  scene.insert(mesh.object("path"));
}

}  // namespace roomgraph
