// SPDX-License-Identifier: BSD-3-Clause
// First lines of truth files, and poses carried over from the robot to its camera.
#include "roomgraph/datasets/truth_file.h"

#include <cstdio>
#include <fstream>
#include <sstream>

namespace roomgraph {
namespace {

constexpr const char* kOfRobot = "# poses of the robot";
constexpr const char* kOfCamera = "# poses of the camera (optical frame)";

}  // namespace

std::string truthComment(TruthOf whose) { return std::string(whose == TruthOf::kRobot ? kOfRobot : kOfCamera) + "\n"; }

std::optional<TruthOf> whoseTruth(const std::filesystem::path& file) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line) && line.starts_with('#');) {
    if (line == kOfRobot) return TruthOf::kRobot;
    if (line == kOfCamera) return TruthOf::kCamera;
  }
  return std::nullopt;
}

std::string truthOnRobot(const std::filesystem::path& file, const Pose3& robot_from_part) {
  std::ifstream in(file);
  std::string out;
  for (std::string line; std::getline(in, line);) {
    double x, y, z, qx, qy, qz, qw;
    std::string stamp;  // as it stands there: nanoseconds do not fit into a double
    std::istringstream words(line);
    if (line.starts_with('#') || !(words >> stamp >> x >> y >> z >> qx >> qy >> qz >> qw)) continue;
    Pose3 world_from_robot = Pose3::Identity();
    world_from_robot.translation() << x, y, z;
    world_from_robot.linear() = Eigen::Quaterniond(qw, qx, qy, qz).normalized().toRotationMatrix();
    const Pose3 pose = world_from_robot * robot_from_part;
    const Eigen::Quaterniond q(pose.linear());
    const auto p = pose.translation();
    char text[256];
    std::snprintf(text, sizeof text, " %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
    out += stamp + text;
  }
  return out;
}

}  // namespace roomgraph
