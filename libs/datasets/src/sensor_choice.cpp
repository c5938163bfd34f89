// SPDX-License-Identifier: BSD-3-Clause
// Sensor labels of a rawlog, checked against those asked for.
#include "sensor_choice.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <cmath>

#include "record_source.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph {
namespace {

using mrpt::obs::CObservation;

bool contains(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

void addOnce(std::vector<std::string>& list, const std::string& item) {
  if (!contains(list, item)) list.push_back(item);
}

// Labels in the order in which they appear; `placed`: of cameras and lidars, which have a place on the
// robot; `wheels`: "wheels" when there is odometry of any kind.
struct Labels {
  std::vector<std::string> rgbd, lidar, odometry, placed, wheels;

  void add(const CObservation& observation) {
    const std::string& label = observation.sensorLabel;
    const bool is_camera = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation);
    const bool is_lidar = dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation);
    if (is_camera) addOnce(rgbd, label);
    if (is_lidar) addOnce(lidar, label);
    if (is_camera || is_lidar) addOnce(placed, label);
    if (dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) addOdometry(label);
  }
  void addOdometry(const std::string& label) {
    addOnce(odometry, label);
    addOnce(wheels, "wheels");
  }
  void add(const mrpt::serialization::CSerializable::Ptr& object) {
    if (std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object)) addOnce(wheels, "wheels");
    if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) {
      for (const auto& observation : *frame)
        if (observation) add(*observation);
    } else if (const auto observation = std::dynamic_pointer_cast<CObservation>(object)) {
      add(*observation);
    }
  }
};

// A label that was asked for, and the list in which it must occur.
struct Request {
  std::string kind, label;
  std::vector<std::string> Labels::*list;
};

std::vector<Request> requestsOf(const ReadOptions& options) {
  std::vector<Request> requests;
  const auto ask = [&](bool wanted, const std::string& kind, const std::string& label, auto list) {
    if (wanted && !label.empty()) requests.push_back({kind, label, list});
  };
  ask(options.frames, "RGB-D camera", options.rgbd_label, &Labels::rgbd);
  ask(options.scans, "lidar", options.lidar_label, &Labels::lidar);
  ask(options.odometry, "odometry", options.odometry_label, &Labels::odometry);
  for (const auto& [label, pose] : options.sensor_poses)
    requests.push_back({"camera or lidar", label, &Labels::placed});
  const RecordCorrections& corrections = options.corrections;
  for (const auto& [label, offset] : corrections.time_offsets_s)
    requests.push_back({"camera or lidar", label, &Labels::placed});
  if (corrections.wheels != WheelCorrection{} || corrections.wheels_time_offset_s != 0)
    requests.push_back({"odometry of", "wheels", &Labels::wheels});
  return requests;
}

std::string listed(const std::vector<std::string>& labels) {
  std::vector<std::string> names;
  names.reserve(labels.size());
  for (const auto& label : labels) names.push_back(labelText(label));
  return names.empty() ? "none" : join(names);
}

// Up to 2 % of the image a camera may have been calibrated again.
bool sameIntrinsics(const PinholeCamera& a, const PinholeCamera& b) {
  const double tolerance_px = 0.02 * a.width;
  const auto close = [&](double x, double y) { return std::abs(x - y) <= tolerance_px; };
  return a.width == b.width && a.height == b.height && close(a.fx, b.fx) && close(a.fy, b.fy) &&
         close(a.cx, b.cx) && close(a.cy, b.cy);
}

// Faster than heads and lifts of robots move; slack for angles that were read a moment before the image.
constexpr double kFastestHead_m_s = 1, kFastestHead_rad_s = 4;
constexpr double kHeadSlack_m = 0.02, kHeadSlack_rad = 0.03;

bool reaches(const Pose3& from, const Pose3& to, double seconds) {
  const Pose3 motion = from.inverse() * to;
  return motion.translation().norm() <= kHeadSlack_m + kFastestHead_m_s * seconds &&
         rotationAngle(motion) <= kHeadSlack_rad + kFastestHead_rad_s * seconds;
}

}  // namespace

std::string labelText(const std::string& label) {
  return "'" + label + "'";
}

bool OneCamera::takes(const Frame& frame) {
  if (last_ && !(sameIntrinsics(last_->camera, frame.camera) &&
                 reaches(last_->robot_from_camera, frame.robot_from_camera, std::abs(frame.t - last_->t))))
    return false;
  last_ = {frame.t, last_ ? last_->camera : frame.camera, frame.robot_from_camera};
  return true;
}

bool SensorChoice::takes(const std::string& label) {
  addOnce(seen_, label);
  return label == (label_.empty() ? seen_.front() : label_);
}

std::string SensorChoice::what() const {
  if (!label_.empty() || seen_.size() < 2) return "";
  return "several sensors of one kind (" + kind_ + "): " + labelText(seen_.front()) + " is used, " +
         listed({seen_.begin() + 1, seen_.end()}) + " not";
}

std::string SensorChoice::hint() const {
  if (seen_.size() < 2) return "";
  const auto other =
      std::find_if(seen_.begin() + 1, seen_.end(), [](const auto& label) { return !label.empty(); });
  if (other == seen_.end())
    return "a sensor without a label cannot be chosen: give it one first (RawLogViewer of MRPT can)";
  return "choose with --set " + section_ + ".label=" + *other;
}

std::vector<std::string> SensorChoices::warnings() const {
  std::vector<std::string> out;
  for (const auto* choice : {&rgbd, &lidar, &odometry})
    if (const auto what = choice->what(); !what.empty()) out.push_back(what + "; " + choice->hint());
  return out;
}

void placeSensor(CObservation& observation, const SensorPoses& poses) {
  const auto pose = poses.find(observation.sensorLabel);
  if (pose != poses.end()) observation.setSensorPose(toMrpt(pose->second));
}

void checkLabels(const std::filesystem::path& file, const ReadOptions& options) {
  auto missing = requestsOf(options);
  if (missing.empty()) return;
  RecordSource source(file);
  Labels labels;
  while (!missing.empty()) {
    const auto item = source.next();
    if (!item) break;
    if (item->object) labels.add(item->object);
    std::erase_if(missing, [&](const Request& r) { return contains(labels.*r.list, r.label); });
  }
  if (missing.empty()) return;
  const auto& [kind, label, list] = missing.front();
  const auto& known = labels.*list;
  throw ConfigError(file.string() + ": no " + kind + " " + labelText(label) + didYouMean(label, known) +
                    "; there is: " + listed(known));
}

}  // namespace roomgraph
