// SPDX-License-Identifier: BSD-3-Clause
// Sensor poses on the robot by label, parsed from and formatted as text.
#pragma once

#include <map>
#include <string>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// robot_from_sensor by sensor label. A camera looks along its x axis, as in MRPT's sensorPose: for RGB-D it
/// is the place of the depth camera.
using SensorPoses = std::map<std::string, Pose3>;

/// "x,y,z,yaw,pitch,roll" in metres and degrees, as `roomgraph info` prints it. Throws ConfigError: not
/// exactly six finite numbers, or further than 1000 m from the robot. `context` begins its message.
Pose3 parsePose(const std::string& text, const std::string& context);

/// "LABEL=x,y,z,yaw,pitch,roll", several separated by commas; of two for one label the last one counts.
/// Throws ConfigError like parsePose().
SensorPoses parseSensorPoses(const std::string& text, const std::string& context);

/// The inverse of parsePose(), rounded to 1 mm and 0.01 deg.
std::string formatPose(const Pose3& pose);

}  // namespace roomgraph
