// SPDX-License-Identifier: BSD-3-Clause
// Shortest recordings with every kind of record, and checks that records are finite.
#pragma once

#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "rawlog_maker.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/observations/detection_comment.h"
#include "roomgraph/observations/register_classes.h"

namespace roomgraph::test {

/// A recording as short as it can be with one of each kind of record before, in and after its middle.
struct ThreeFrames {
  std::vector<test::Object> records;

  std::string bytes() const {
    std::string out;
    for (const auto& record : records) out += test::bytesOf(record);
    return out;
  }
};

inline std::shared_ptr<CObservationDetections> makeDetections(double t) {
  auto out = std::make_shared<CObservationDetections>();
  out->timestamp = mrpt::Clock::fromDouble(t);
  out->sensorLabel = "DETECTIONS";
  out->image_width = 64;
  out->image_height = 48;
  out->model = "made up";
  out->items.push_back({"chair", 0.75, 10, 12, 30, 40, 4, {20, 28, {100, 300, 160}}});
  out->items.push_back({"sofa", 0.5, 5.5, 6.5, 40, 44, -1, {}});
  return out;
}

/// Odometry, scan, detections, images: three times, 0.1 s apart.
inline ThreeFrames threeFrames(int width = 64, int height = 48) {
  observations::registerClasses();
  ThreeFrames out;
  for (int i = 0; i < 3; ++i) {
    const double t = 1000 + 0.1 * i;
    out.records.push_back(test::makeOdometry(t, 0.04 * i, 0, 0.01 * i));
    out.records.push_back(test::makeScan(t + 0.01, 2, 60));
    out.records.push_back(makeDetections(t + 0.02));
    out.records.push_back(test::makeImages(t + 0.02, width, height));
  }
  return out;
}

/// The same as actions and sensory frames in turn, boxes as comments.
inline ThreeFrames threePairs(int width = 64, int height = 48) {
  observations::registerClasses();
  ThreeFrames out;
  for (int i = 0; i < 3; ++i) {
    const double t = 1000 + 0.1 * i;
    const auto boxes = std::make_shared<mrpt::obs::CObservationComment>(toComment(*makeDetections(t + 0.02)));
    out.records.push_back(test::makeAction(t, 0.04, 0, 0.01));
    out.records.push_back(test::makeSensoryFrame(
        {test::makeScan(t + 0.01, 2, 60), boxes, test::makeImages(t + 0.02, width, height)}));
  }
  return out;
}

inline bool isFinite(const Scan& scan) {
  bool finite = scan.robot_from_lidar.matrix().allFinite() && std::isfinite(scan.angle_min_rad) &&
                std::isfinite(scan.angle_step_rad) && std::isfinite(scan.max_range_m);
  for (const float range : scan.ranges_m) finite = finite && std::isfinite(range);
  return finite;
}
inline bool isFinite(const Frame& frame) {
  const auto& c = frame.camera;
  return frame.robot_from_camera.matrix().allFinite() && c.valid() &&
         std::isfinite(c.fx + c.fy + c.cx + c.cy);
}
inline bool isFinite(const OdometryReading& reading) {
  const Pose2& pose = reading.odom_from_robot;
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.yaw);
}
inline bool isFinite(const std::shared_ptr<CObservationDetections>& detections) {
  bool finite = true;
  for (const auto& item : detections->items)
    finite = finite && std::isfinite(item.score + item.u_min + item.v_min + item.u_max + item.v_max);
  return finite;
}
inline bool isFinite(const Record& record) {
  return std::isfinite(timeOf(record)) &&
         std::visit([](const auto& value) { return isFinite(value); }, record);
}

}  // namespace roomgraph::test
