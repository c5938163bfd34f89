// SPDX-License-Identifier: BSD-3-Clause
// Simulated lap through the asymmetric room: scans, wheels, frames and setup.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <string>

#include "roomgraph/pipeline/semantic_slam.h"
#include "synthetic_scans.h"

namespace roomgraph::test {

/// A run with the shipped object database and the given settings.
inline std::unique_ptr<Setup> setupWith(const std::string& config) {
  return makeSetup(Config::fromText(config, "test"), ROOMGRAPH_SOURCE_DIR "/objects.ini");
}

/// A lap of 12 s through the asymmetric room; the world is the first pose.
struct Drive {
  static constexpr double kLap_s = 12;
  std::mt19937 random{7};

  static Pose2 truth(double t) {
    const double angle = 2 * M_PI * t / kLap_s;
    return {1.1 * std::sin(angle), 1.1 * (1 - std::cos(angle)), wrapAngle(angle)};
  }
  Scan scan(double t) { return castScan(asymmetricRoom(), truth(t), t, random, 0.01, 720); }
  /// Wheels that turn 6 % too far.
  OdometryReading odometry(double t) const {
    const double angle = 1.06 * 2 * M_PI * t / kLap_s;
    return {t, {1.1 / 1.06 * std::sin(angle), 1.1 / 1.06 * (1 - std::cos(angle)), wrapAngle(angle)}};
  }
  static Pose3 robotFromCamera() {
    Pose3 pose = poseFromYpr(0.1, 0, 1, 0, 0, 0);
    pose.linear() = bodyFromOptical();
    return pose;
  }
  static Frame frame(double t) {
    Frame out;
    out.id = FrameId{static_cast<std::int64_t>(std::lround(10 * t))};
    out.t = t;
    out.camera = {320, 240, 260, 260, 159.5, 119.5, {}};
    out.robot_from_camera = robotFromCamera();
    out.gray = cv::Mat(240, 320, CV_8UC1, cv::Scalar(100));
    out.color = cv::Mat(240, 320, CV_8UC3, cv::Scalar(100, 100, 100));
    out.depth = cv::Mat(240, 320, CV_32FC1, cv::Scalar(0));
    return out;
  }
};

}  // namespace roomgraph::test
