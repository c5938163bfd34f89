// SPDX-License-Identifier: BSD-3-Clause
// From recordings to a calibration: what is asked for, where it starts, and what it changes.
#include "roomgraph/calibration/calibrate.h"

#include <mrpt/poses/CPose3D.h>

#include "estimate_calibration.h"
#include "read_evidence.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

void setPose(const Pose3& robot_from_camera, ParameterVector& out) {
  Pose3 forward = robot_from_camera;
  forward.linear() = robot_from_camera.linear() * bodyFromOptical().transpose();
  const auto pose = toMrpt(forward).asTPose();
  out.segment<6>(kCameraX) << pose.x, pose.y, pose.z, pose.yaw, pose.pitch, pose.roll;
}

ParameterVector startOf(const SensorsBefore& sensors) {
  ParameterVector out = ParameterVector::Zero();
  out[kWheelScale] = out[kTurnScale] = out[kDepthScale] = 1;
  if (sensors.robot_from_lidar) {
    const Pose2 lidar = planarPart(*sensors.robot_from_lidar);
    out.segment<3>(kLidarX) << lidar.x, lidar.y, lidar.yaw;
  }
  if (sensors.robot_from_camera) setPose(*sensors.robot_from_camera, out);
  return out;
}

std::bitset<kParameterCount> heldOf(const SensorsBefore& sensors) {
  std::bitset<kParameterCount> held;
  const auto hold = [&](int from, int to) {
    for (int i = from; i <= to; ++i) held.set(static_cast<std::size_t>(i));
  };
  const bool lidar = sensors.robot_from_lidar.has_value(), wheels = sensors.wheels;
  if (!lidar || !wheels) hold(kLidarX, kLidarYaw);
  if (!lidar || !wheels) hold(kWheelTime, kWheelTime);
  if (!lidar && !sensors.board_depth) hold(kDepthScale, kDepthScale);  // it would shrink with the camera's height
  if (!wheels) hold(kWheelScale, kHeadingDrift);
  if (!sensors.depth) hold(kDepthScale, kDepthBias);
  if (!sensors.depth && !sensors.board) hold(kCameraX, kCameraTime);
  if (!lidar) {  // the floor alone
    hold(kWheelScale, kHeadingDrift);
    hold(kCameraX, kCameraY);
    hold(kCameraYaw, kCameraYaw);
    hold(kCameraTime, kCameraTime);
  }
  return held;
}

std::string frameOf(const SensorsBefore& sensors) {
  if (sensors.robot_from_lidar && sensors.wheels)
    return "the robot's frame is that of the wheel odometry on the floor; the clock is that of the lidar, "
           "whose height, "
           "pitch and roll are taken as recorded";
  if (sensors.robot_from_lidar)
    return "without wheel odometry, the lidar's recorded place says where the robot's frame is; the clock is "
           "that of the "
           "lidar";
  if (sensors.board_depth)
    return "without lidar the floor says height, pitch and roll of the camera, and the board depth";
  return "without lidar only the floor says something: height, pitch and roll of the "
         "camera";
}

Pose3 cameraPose(const ParameterVector& p) {
  Pose3 out =
      poseFromYpr(p[kCameraX], p[kCameraY], p[kCameraZ], p[kCameraYaw], p[kCameraPitch], p[kCameraRoll]);
  out.linear() *= bodyFromOptical();
  return out;
}

Calibration calibrationOf(const SensorsBefore& sensors, const CalibrationEstimate& estimate) {
  Calibration out;
  const ParameterVector& p = estimate.after;
  if (sensors.robot_from_lidar) {
    const Pose2 before = planarPart(*sensors.robot_from_lidar);
    const Pose3 step = toPose3(Pose2{p[kLidarX], p[kLidarY], p[kLidarYaw]} * before.inverse());
    out.poses[sensors.lidar_label] = normalized(step * *sensors.robot_from_lidar);
  }
  auto& corrections = out.corrections;
  if (sensors.robot_from_camera) {
    out.poses[sensors.camera_label] =
        normalized(cameraPose(p) * sensors.robot_from_camera->inverse() * sensors.robot_from_depth);
    corrections.time_offsets_s[sensors.camera_label] = p[kCameraTime];
    corrections.depth = {p[kDepthScale], p[kDepthBias]};
  }
  if (sensors.wheels) {
    corrections.wheels_time_offset_s = p[kWheelTime];
    corrections.wheels = {p[kWheelScale], p[kTurnScale], p[kHeadingDrift]};
  }
  return out;
}

void addModelErrors(CalibrationEstimate& estimate) {
  for (int i = 0; i < kParameterCount; ++i) {
    const double sigma = parameterTraits()[static_cast<std::size_t>(i)].model_error;
    if (estimate.covariance(i, i) > 0) estimate.covariance(i, i) += sigma * sigma;
  }
}

constexpr double kSteepest_rad = 80 / kDegreesPerRadian;

void requireUsable(const SensorsBefore& sensors, const std::filesystem::path& recording) {
  const bool both = sensors.robot_from_camera && sensors.robot_from_lidar;
  if (both && sensors.camera_label == sensors.lidar_label)
    throw InputError(recording.string() + ": camera and lidar have one label, '" + sensors.camera_label +
                     "', by which a calibration could not tell them apart");
  if (!sensors.robot_from_camera) return;
  const double ahead_z = sensors.robot_from_camera->linear()(2, 2);  // of the optical axis, seen from the robot
  if (std::abs(ahead_z) > std::sin(kSteepest_rad))
    throw InputError(recording.string() + ": the camera's recorded pose looks straight " + (ahead_z < 0 ? "down" : "up") +
                     ", where yaw and roll are one: it cannot be calibrated");
}

}  // namespace

CalibrationReport calibrate(const std::vector<std::filesystem::path>& recordings, const ReadOptions& read,
                            const std::optional<Board>& board, const CalibrationProgress& progress) {
  CalibrationReport out;
  CalibrationTask task;
  for (const auto& recording : recordings)
    task.evidence.push_back(readEvidence(recording, read, board, out.sensors, [&](double share) {
      if (progress) progress("read " + recording.filename().string(), share);
    }));
  if (!out.sensors.robot_from_camera && !out.sensors.robot_from_lidar)
    throw InputError(recordings.front().string() +
                     ": no camera with depth and no lidar: nothing to calibrate");
  if (board && !out.sensors.board)
    throw InputError(recordings.front().string() + (recordings.size() > 1 ? " and the others" : "") +
                     ": no image shows a whole chessboard of " + std::to_string(board->columns) + " by " +
                     std::to_string(board->rows) + " inner corners, sharp and with a white edge around it");
  requireUsable(out.sensors, recordings.front());
  task.before = startOf(out.sensors);
  task.held = heldOf(out.sensors);
  if (out.sensors.robot_from_lidar) task.lidar_z_m = out.sensors.robot_from_lidar->translation().z();
  out.estimate = estimateCalibration(task, [&](double share) {
    if (progress) progress("estimate", share);
  });
  addModelErrors(out.estimate);
  out.calibration = calibrationOf(out.sensors, out.estimate);
  out.frame = frameOf(out.sensors);
  return out;
}

}  // namespace roomgraph
