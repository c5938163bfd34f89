// SPDX-License-Identifier: BSD-3-Clause
// Choice of one sensor per kind, by label or first appearance; overriding of sensor poses.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/observations/frame.h"

namespace roomgraph {

/// Of several sensors of one kind only one is used: the one asked for, or the first that appears.
class SensorChoice {
 public:
  /// `kind`: "RGB-D camera", "lidar" …; `section`: of the config, where its label stands; `label`: the one
  /// asked for, or empty.
  SensorChoice(std::string kind, std::string section, std::string label)
      : kind_(std::move(kind)), section_(std::move(section)), label_(std::move(label)) {}

  /// Whether records of this sensor are used. Sensors are to be asked about in the order in which they
  /// appear.
  bool takes(const std::string& label);
  /// Empty unless there are several and none was asked for.
  std::string what() const;
  std::string hint() const;

 private:
  std::string kind_, section_, label_;
  std::vector<std::string> seen_;
};

/// The kinds of sensors that a recording may hold several of.
struct SensorChoices {
  SensorChoice rgbd, lidar, odometry;
  explicit SensorChoices(const ReadOptions& options = {})
      : rgbd("RGB-D camera", "rgbd", options.rgbd_label),
        lidar("lidar", "lidar", options.lidar_label),
        odometry("odometry", "odometry", options.odometry_label) {}
  /// One sentence for each kind of which there are several and none was asked for.
  std::vector<std::string> warnings() const;
};

/// Puts the observation's sensor where `poses` says, if it says anything about its label.
void placeSensor(mrpt::obs::CObservation& observation, const SensorPoses& poses);

/// Throws ConfigError when a label that `options` name does not occur in the file, listing those that do.
/// Reads no further than until all are found; not at all when none is named.
void checkLabels(const std::filesystem::path& file, const ReadOptions& options);

/// Tells several cameras that were recorded with one label apart: images of the first one alone are taken.
class OneCamera {
 public:
  /// False for another size, other focal lengths or another principal point (by more than 2 % of the image),
  /// and for a sensor pose that no pan-tilt head reaches in the time since the last image that was taken.
  bool takes(const Frame& frame);

 private:
  struct Taken {
    double t;  ///< s
    PinholeCamera camera;
    Pose3 robot_from_camera;
  };
  std::optional<Taken> last_;
};

/// A label as it stands in messages.
std::string labelText(const std::string& label);

}  // namespace roomgraph
