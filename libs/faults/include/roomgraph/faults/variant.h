// SPDX-License-Identifier: BSD-3-Clause
// The same drive as another recording: backwards, mirrored or with less to see, and its truth along with it.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace roomgraph {

/// What becomes of the recording, in this order.
struct VariantOptions {
  int every_scan = 1, every_image = 1;  ///< keep the first of so many
  int every_beam = 1;                   ///< of each scan, keep the middle one of so many
  double field_of_view_rad = std::numeric_limits<double>::infinity();  ///< of the lidar, about its middle
  double farthest_m = std::numeric_limits<double>::infinity();  ///< longer ranges become beams without return
  bool mirrored = false;       ///< left and right change places: the robot's y becomes -y
  double stamps_apart_s = 0;   ///< new stamps in the order of the file; those that are equal stay so. 0: as recorded
  bool backwards = false;      ///< the last becomes the first; among records of one stamp the order stays
};

/// A file about the recording that goes along with it, whose times and sides become those of the variant.
struct VariantTruth {
  enum class Kind {
    kRelations,         ///< `t1 t2 x y z roll pitch yaw` of the robot
    kRobotTrajectory,   ///< TUM, x forward, y left
    kCameraTrajectory,  ///< TUM, of the optical frame
    kBoxes              ///< boxes.jsonl or detections.jsonl
  };
  Kind kind;
  std::filesystem::path input, output;
};

struct VariantResult {
  int read = 0, written = 0;           ///< observations
  std::map<std::string, int> skipped;  ///< left out, by reason: broken, or of a kind that cannot be mirrored or reversed
  std::string truncation;              ///< of an input that is cut off: where; else empty
};

/// Makes a recording of the same rooms that no estimator was tuned to. What is not changed keeps its bytes;
/// pictures that are made anew are stored without loss. Holds the recording in memory. Played backwards, odometry
/// keeps its poses, and velocities change their sign; wheel ticks are left out of what is mirrored or reversed, as are
/// observations other than RGB-D images, scans, odometry and detections. Truths that are mirrored are so in the
/// plane y = 0 of their world.
///
/// Throws ConfigError (nothing to do, impossible value, outputs that are inputs), InputError (an input cannot be
/// read: file, line, cause; a time that no record has, where stamps are new) or RunError (an output cannot be written).
VariantResult writeVariant(const std::filesystem::path& input, const std::filesystem::path& output,
                           const VariantOptions& options, const std::vector<VariantTruth>& truths = {},
                           const std::function<void(double share)>& progress = nullptr);

}  // namespace roomgraph
