// SPDX-License-Identifier: BSD-3-Clause
// Import of ROS 1 and ROS 2 bags as rawlogs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/datasets/sensor_poses.h"
#include "roomgraph/geometry/camera.h"

namespace roomgraph {

/// Which clock gives the records their times.
enum class BagTimes {
  kHeader,     ///< what the drivers wrote; where they wrote nothing, when the recorder got the message
  kReceived,   ///< when the recorder got the message
  kCorrected,  ///< what the drivers wrote, shifted for each topic by its median difference to the recorder
};

struct BagImportOptions {
  /// "NAME" or "KIND=NAME", KIND being one of bagTopicKinds(); "KIND=none" leaves a kind out. What is not
  /// named is found by type.
  std::vector<std::string> topics;
  std::string base_frame;  ///< robot; empty: found by name
  std::string truth;       ///< frame of tf or topic; empty: found by name; "none"
  BagTimes times = BagTimes::kHeader;
  double max_time_difference_s = 0.02;  ///< between colour and depth
  std::optional<PinholeCamera> camera;  ///< stands for CameraInfo; size 0: that of the images
  SensorPoses sensor_poses;             ///< robot_from_sensor by label of the record, instead of tf
  std::optional<int> jpeg_quality;      ///< of colour in the rawlog; nothing: without loss
  bool external_images = false;         ///< colour as PNG or as the bag's own JPEG, in X_Images/
};

/// color, depth, color_info, depth_info, scan, odometry, imu, tf.
const std::vector<std::string>& bagTopicKinds();

struct BagTopicInfo {
  std::string name, type;
  std::string detail;  ///< encoding and size of images, frame: "rgb8 640x480, frame camera_rgb_optical_frame"
  std::uint64_t count = 0;                        ///< messages
  double first_s = 0, last_s = 0;                 ///< received
  std::optional<double> header_minus_received_s;  ///< median; nothing when the type has no time of its own
  std::string used_as;                            ///< kind it is imported as without --topic; empty: not used
};

struct BagContents {
  std::vector<BagTopicInfo> topics;  ///< by name
  std::vector<std::string> frames;   ///< of tf
  std::vector<std::string> warnings;
};

/// What is in a bag. `progress` gets the share read, and may throw to end it. Throws InputError.
BagContents listBag(const std::filesystem::path& bag,
                    const std::function<void(double share)>& progress = nullptr);

struct BagImportResult {
  std::map<std::string, int> written;  ///< records by label
  std::map<std::string, int> skipped;  ///< messages left out by reason
  std::vector<std::string> used;       ///< "color: /camera/rgb/image_raw", in the order of the kinds
  std::string base_frame;              ///< empty: no robot, the camera is handheld
  std::filesystem::path ground_truth;  ///< file written; empty when the bag has none
  std::string truth;  ///< what it is: "tf world -> base_link", poses of the robot or of the camera
  std::vector<std::string> warnings;
};

/// Writes a bag (ROS 1: .bag; ROS 2: .db3, or the folder of one) as an observation-only rawlog in order of
/// time: CObservation3DRangeScan (colour and depth paired by their header times, intrinsics),
/// CObservation2DRangeScan, CObservationOdometry, CObservationIMU. The bag is read twice, first without
/// images (what there is, frames, clocks), with memory for a few seconds of it. Places of sensors come from
/// tf and tf_static; those that move are looked up for each record. Ground truth, where tf or a topic has it,
/// goes to X.groundtruth.txt: poses of the robot, of a handheld camera those of its optical frame.
///
/// A scan gets the time of the middle of its sweep. Depth of 32FC1 is written in units of 0.2 mm.
///
/// What is broken or not known is left out, counted and told. Throws InputError (no bag, nothing usable in
/// it), ConfigError (options that name what is not there, a place to write that is read) or RunError (output
/// cannot be written).
BagImportResult importBag(const std::filesystem::path& bag, const std::filesystem::path& rawlog,
                          const BagImportOptions& options = {},
                          const std::function<void(double share)>& progress = nullptr);

}  // namespace roomgraph
