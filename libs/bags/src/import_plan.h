// SPDX-License-Identifier: BSD-3-Clause
// What an import does with a bag, decided before its second reading.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "camera_model.h"
#include "survey.h"
#include "topic_choice.h"

namespace roomgraph::bags {

/// Poses by tf at the times of one of its edges.
struct TfTrack {
  FrameGraph::Way way;
  std::size_t edge = 0;
};

struct TruthPlan {
  std::string name;  ///< "tf world -> base_link", "/mocap/pose"; empty: none
  std::optional<TfTrack> track;
  std::optional<std::size_t> topic;  ///< Odometry or PoseStamped
  std::string frame;                 ///< whose poses the topic has; empty: those of the robot or camera
};

struct ImportPlan {
  TopicChoice choice;
  std::string robot;                              ///< frame; empty: handheld
  std::string handheld;                           ///< optical frame of a handheld camera
  std::map<std::size_t, std::string> labels;      ///< of topics with records of their own
  std::map<std::size_t, std::int64_t> shifts_ns;  ///< added to the header times of a topic
  std::optional<CameraModel> color, depth;        ///< of the chosen images; none: they cannot be used
  std::string depth_frame;                        ///< where the depth camera is
  TruthPlan truth;
  std::optional<TfTrack> odometry;  ///< when no topic has it
  double window_s = 1;              ///< by which records may be out of order
  std::vector<std::string> warnings;
  std::string odometry_frame;  ///< of a chosen topic that tells of another frame than the robot's; else empty
};

/// Throws ConfigError (options that name what is not there), InputError (nothing in the bag can be imported).
ImportPlan planImport(const Survey& survey, const BagImportOptions& options, const std::string& bag);

/// Topics whose clocks disagree, one line each, and shifts and window of the plan.
void planTimes(const Survey& survey, const BagImportOptions& options, ImportPlan& plan);
/// Camera models, and whether depth is registered to colour.
void planCameras(const Survey& survey, const BagImportOptions& options, ImportPlan& plan);

}  // namespace roomgraph::bags
