// SPDX-License-Identifier: BSD-3-Clause
// SensorFrames: where sensors sit on the robot, by the name of their frame.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "frame_graph.h"
#include "roomgraph/core/outcome.h"

namespace roomgraph::bags {

/// Places of sensors by tf. Frames that tf does not connect with the robot get the identity, and a warning.
class SensorFrames {
 public:
  /// `robot`: frame of the robot. `handheld`: optical frame of a camera that is the robot itself, then
  /// `robot` is empty.
  SensorFrames(const FrameGraph& graph, std::string robot, std::string handheld);

  /// robot_from_sensor. Fails when a joint on the way moves and its transforms at that time are missing.
  Outcome<Pose3> at(const std::string& frame, std::int64_t t_ns);
  /// The same of a camera, optical axes. A frame whose name does not say "optical" and whose z axis points up
  /// is taken for one with x forward, as some simulators write it, with a warning.
  Outcome<Pose3> opticalAt(const std::string& frame, std::int64_t t_ns);
  /// Whether tf connects the frame with the robot.
  bool connected(const std::string& frame);
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  const std::optional<FrameGraph::Way>& wayTo(const std::string& frame);

  const FrameGraph& graph_;
  std::string root_;
  Pose3 robot_from_root_ = Pose3::Identity();
  std::map<std::string, std::optional<FrameGraph::Way>> ways_;
  std::map<std::string, bool> x_forward_;
  std::vector<std::string> warnings_;
};

}  // namespace roomgraph::bags
