// SPDX-License-Identifier: BSD-3-Clause
// Synthetic recording of a few seconds with lidar, RGB-D camera and wheel odometry.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "rawlog_maker.h"
#include "roomgraph/geometry/pose.h"
#include "roomgraph/observations/scan.h"
#include "synthetic_scans.h"
#include "textured_room.h"

namespace roomgraph::test {

/// A few seconds of a robot with a lidar, an RGB-D camera and wheel odometry that scales distances by 1.03.
/// Lidar and camera each live in a synthetic room of their own; the movement is the same.
class TinyRecording {
 public:
  struct Parts {
    bool scans = true, frames = true, odometry = true;
  };
  static constexpr double kStart_s = 1000, kStep_s = 0.1;

  explicit TinyRecording(int steps = 24) : steps_(steps) {}

  int steps() const { return steps_; }
  double time(int step) const { return kStart_s + kStep_s * step; }
  /// The world is the robot's first pose. An arc to the left, 4 cm and 0.02 rad a step.
  Pose2 truth(double step) const {
    const double radius = 0.04 / 0.02, yaw = 0.02 * step;
    return {radius * std::sin(yaw), radius * (1 - std::cos(yaw)), yaw};
  }
  Pose2 odometry(int step) const {
    const Pose2 pose = truth(step);
    return {1.03 * pose.x, 1.03 * pose.y, pose.yaw};
  }
  static bool hasFrame(int step) { return step % 2 == 0; }

  std::vector<test::Object> records(const Parts& parts) const {
    std::vector<test::Object> out;
    std::mt19937 random(1);
    for (int i = 0; i < steps_; ++i) {
      if (parts.odometry) {
        const Pose2 odom = odometry(i);
        out.push_back(test::makeOdometry(time(i), odom.x, odom.y, odom.yaw));
      }
      if (parts.scans) out.push_back(scan(i, random));
      if (parts.frames && hasFrame(i)) out.push_back(images(i));
    }
    return out;
  }

  /// The old format: actions and sensory frames in turn.
  std::vector<test::Object> actionRecords() const {
    std::vector<test::Object> out;
    std::mt19937 random(1);
    for (int i = 0; i < steps_; ++i) {
      const Pose2 moved = odometry(std::max(0, i - 1)).inverse() * odometry(i);
      out.push_back(test::makeAction(time(i), moved.x, moved.y, moved.yaw));
      std::vector<mrpt::obs::CObservation::Ptr> seen;
      seen.reserve(2);
      seen.push_back(scan(i, random));
      if (hasFrame(i)) seen.push_back(images(i));
      out.push_back(test::makeSensoryFrame(seen));
    }
    return out;
  }

  mrpt::obs::CObservation2DRangeScan::Ptr scan(int step, std::mt19937& random) const {
    Scan cast = castScan(asymmetricRoom(), truth(step), time(step), random, 0.005, 720);
    cast.sensor_label = "LASER";
    return toMrpt(cast);
  }

  mrpt::obs::CObservation3DRangeScan::Ptr images(int step) const {
    const Frame frame = room_.render(time(step), roomFromWorld() * toPose3(truth(step)) * robotFromCamera());
    const auto& camera = frame.camera;
    auto out = mrpt::obs::CObservation3DRangeScan::Create();
    out->timestamp = mrpt::Clock::fromDouble(time(step));
    out->sensorLabel = "RGBD";
    out->sensorPose = mrpt::poses::CPose3D(0.1, 0, 0.6, 0, 0, 0);
    out->range_is_depth = true;
    out->hasRangeImage = out->hasIntensityImage = true;
    out->rangeUnits = 0.001f;
    out->rangeImage_setSize(camera.height, camera.width);
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u)
        out->rangeImage(v, u) = static_cast<std::uint16_t>(std::lround(1000 * frame.depth.at<float>(v, u)));
    out->intensityImage = mrpt::img::CImage(frame.color, mrpt::img::DEEP_COPY);
    out->relativePoseIntensityWRTDepth = mrpt::poses::CPose3D(0, 0, 0, -M_PI / 2, 0, -M_PI / 2);
    out->cameraParams.ncols = static_cast<std::uint32_t>(camera.width);
    out->cameraParams.nrows = static_cast<std::uint32_t>(camera.height);
    out->cameraParams.setIntrinsicParamsFromValues(camera.fx, camera.fy, camera.cx, camera.cy);
    out->cameraParamsIntensity = out->cameraParams;
    return out;
  }

 private:
  static Pose3 robotFromCamera() {
    Pose3 pose = Pose3::Identity();
    pose.linear() = bodyFromOptical();
    pose.translation() = Eigen::Vector3d(0.1, 0, 0.6);
    return pose;
  }
  // The textured room's y points down and its floor is at y = 1.5.
  static Pose3 roomFromWorld() {
    Pose3 pose = Pose3::Identity();
    pose.linear() = bodyFromOptical().transpose();
    pose.translation() = Eigen::Vector3d(0, 1.5, -1);
    return pose;
  }

  int steps_;
  TexturedRoom room_;
};

}  // namespace roomgraph::test
