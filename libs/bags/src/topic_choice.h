// SPDX-License-Identifier: BSD-3-Clause
// Which topics of a bag are imported as what.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roomgraph/bags/bag_import.h"
#include "survey.h"

namespace roomgraph::bags {

/// Indices of Survey::topics.
struct TopicChoice {
  std::optional<std::size_t> color, depth, color_info, depth_info, odometry;
  std::vector<std::size_t> scans, imus;
  bool tf = true;
  std::vector<std::string> warnings;
};

/// Topics by type, encoding and name, and what `asked_for` (BagImportOptions::topics) says instead. Throws
/// ConfigError: no such topic, or not of that kind.
TopicChoice chooseTopics(const Survey& survey, const std::vector<std::string>& asked_for);

/// Kind under which a topic is imported; empty when it is not.
std::string kindOf(const TopicChoice& choice, const Survey& survey, std::size_t topic);

/// "optical" and the like taken off the name of a frame: label of a camera. "camera_rgb_optical_frame" ->
/// "camera_rgb".
std::string labelOfFrame(std::string frame);

/// Index of the topic with this name; nothing when there is none.
std::optional<std::size_t> findTopic(const Survey& survey, const std::string& name);

/// Whether a topic or a frame of tf tells where the robot really was, by its name: "/mocap/robot",
/// "/gt/odom".
bool namedTruth(const std::string& name);

/// Whether the images of a topic are free of distortion by its name (image_rect).
bool namedRectified(const std::string& topic);

}  // namespace roomgraph::bags
