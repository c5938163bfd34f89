// SPDX-License-Identifier: BSD-3-Clause
// Export of rawlogs and maps as ROS 1 bags.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace roomgraph {

struct BagExportResult {
  std::map<std::string, int> messages;  ///< by topic
  std::vector<std::string> warnings;
};

/// Writes all cameras, lidars, odometry and IMUs of a rawlog as a bag: /camera/rgb/image_raw,
/// /camera/depth/image_raw (16UC1 where the unit is a millimetre, else 32FC1), their camera_info, /scan,
/// /odom, /imu, /tf (odom -> base_link), /tf_static (base_link -> sensors, named by their labels), and
/// /ground_truth when X.groundtruth.txt stands beside the rawlog. A second sensor of a kind has its label in
/// its topics. importBag() makes the same records of it. `progress`
/// gets the share done and may throw to end the export.
///
/// Throws InputError (no rawlog, nothing to export), ConfigError (the bag is the rawlog) or RunError (cannot
/// be written).
BagExportResult exportRecording(const std::filesystem::path& rawlog, const std::filesystem::path& bag,
                                const std::function<void(double share)>& progress = nullptr);

/// Writes a map (map.rgmap, or the folder of a run that has one) as a bag for RViz, all in frame `map`: /map
/// (nav_msgs/OccupancyGrid), /path (nav_msgs/Path), /landmarks (visualization_msgs/MarkerArray: a box or
/// cylinder and a text for each object), /tf (map -> base_link at each pose). Throws InputError, RunError.
BagExportResult exportResult(const std::filesystem::path& result, const std::filesystem::path& bag);

}  // namespace roomgraph
