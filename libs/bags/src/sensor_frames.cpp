// SPDX-License-Identifier: BSD-3-Clause
// Ways from sensor frames to the robot, kept by name; detection of frames that are not optical.
#include "sensor_frames.h"

namespace roomgraph::bags {
namespace {

// Looks at the ceiling as an optical frame, and straight ahead with x forward.
bool standsUpright(const Pose3& robot_from_frame) {
  constexpr double kMostlyUp = 0.87;  // cos of 30 degrees
  return robot_from_frame.linear().col(2).z() > kMostlyUp;
}

}  // namespace

SensorFrames::SensorFrames(const FrameGraph& graph, std::string robot, std::string handheld)
    : graph_(graph), root_(robot.empty() ? std::move(handheld) : robot) {
  if (robot.empty()) robot_from_root_.linear() = bodyFromOptical();
}

const std::optional<FrameGraph::Way>& SensorFrames::wayTo(const std::string& frame) {
  const auto known = ways_.find(frame);
  if (known != ways_.end()) return known->second;
  auto way = graph_.way(root_, frame);
  if (!way) {
    const std::string name = frame.empty() ? "sensors without a frame" : "frame '" + frame + "'";
    warnings_.push_back(name +
                        (root_.empty() ? ": the robot's frame is not known (--base names it)"
                                       : ": no transform to '" + root_ + "'") +
                        "; taken to be there (--pose places a sensor)");
  }
  return ways_.emplace(frame, std::move(way)).first->second;
}

bool SensorFrames::connected(const std::string& frame) {
  return wayTo(frame).has_value();
}

Outcome<Pose3> SensorFrames::at(const std::string& frame, std::int64_t t_ns) {
  const auto& way = wayTo(frame);
  if (!way) return Pose3::Identity();
  const auto pose = graph_.at(*way, t_ns);
  if (!pose)
    return Outcome<Pose3>::failure("no transform from '" + frame + "' to '" + root_ + "' at its time");
  return robot_from_root_ * *pose;
}

Outcome<Pose3> SensorFrames::opticalAt(const std::string& frame, std::int64_t t_ns) {
  Pose3 forward_from_optical = Pose3::Identity();
  forward_from_optical.linear() = bodyFromOptical();
  if (!wayTo(frame)) return forward_from_optical;
  auto pose = at(frame, t_ns);
  if (!pose) return pose;
  const auto known = x_forward_.find(frame);
  bool x_forward = known != x_forward_.end() && known->second;
  if (known == x_forward_.end()) {
    x_forward = frame.find("optical") == std::string::npos && standsUpright(*pose);
    x_forward_[frame] = x_forward;
    if (x_forward)
      warnings_.push_back("frame '" + frame +
                          "' of a camera is not optical (its z axis points up): taken as x forward");
  }
  return x_forward ? Outcome<Pose3>(*pose * forward_from_optical) : pose;
}

}  // namespace roomgraph::bags
