// SPDX-License-Identifier: BSD-3-Clause
// X.groundtruth.txt beside an imported rawlog: whose poses they are.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Whose poses a file of ground truth holds: the robot's, or a camera's (optical frame).
enum class TruthOf { kRobot, kCamera };

/// The comment with which imports begin the file, with its line break.
std::string truthComment(TruthOf whose);

/// What that comment says; nothing where there is none, or no such file.
std::optional<TruthOf> whoseTruth(const std::filesystem::path& file);

/// The file's "t tx ty tz qx qy qz qw" lines, poses of a robot, as those of what stands on it. Comments, and what is no pose, go.
std::string truthOnRobot(const std::filesystem::path& file, const Pose3& robot_from_part);

}  // namespace roomgraph
