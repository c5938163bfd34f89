// SPDX-License-Identifier: BSD-3-Clause
// Shifted stamps, turned sensors, corrected depths, odometry summed up again from corrected movements.
#include "record_correction.h"

#include <mrpt/core/Clock.h>

#include <cstdio>

namespace roomgraph {
namespace {

constexpr const char* kOdometry = "odometry";

double secondsOf(const std::string& label, const std::map<std::string, double>& by_label) {
  const auto found = by_label.find(label);
  return found == by_label.end() ? 0 : found->second;
}

std::string quoted(const std::string& label) { return "'" + label + "'"; }

}  // namespace

double RecordCorrection::offsetOf(const std::string& label) const { return secondsOf(label, corrections_.time_offsets_s); }

double RecordCorrection::jumpOf(const std::string& label) const { return secondsOf(label, corrections_.time_jumps_s); }

void RecordCorrection::applyToStamp(double& t, const std::string& label) {
  const bool jumped = jumps_.add(label, t, -jumpOf(label));
  shift(t, quoted(label), offsetOf(label) + (jumped ? jumpOf(label) : 0));
}

void RecordCorrection::shift(double& t, const std::string& sensor, double seconds) {
  if (seconds == 0) return;
  t += seconds;
  char text[32];
  std::snprintf(text, sizeof text, "%+.4f s", seconds);
  ++counts_["stamp of " + sensor + " " + text];
}

void RecordCorrection::turn(Pose3& robot_from_sensor, const std::string& label) {
  const auto found = corrections_.turns.find(label);
  if (found == corrections_.turns.end()) return;
  robot_from_sensor.linear() = found->second.toRotationMatrix() * robot_from_sensor.linear();
  ++counts_["pose of " + quoted(label)];
}

void RecordCorrection::apply(Frame& frame) {
  applyToStamp(frame.t, frame.sensor_label);
  turn(frame.robot_from_camera, frame.sensor_label);
  if (corrections_.depth == DepthCorrection{} || !frame.hasDepth()) return;
  frame.depth = frame.depth.clone();
  for (float& z : cv::Mat_<float>(frame.depth))
    if (z > 0)
      z = std::max(0.f, static_cast<float>(corrections_.depth.scale * z + corrections_.depth.bias_m));
  ++counts_["depth of '" + frame.sensor_label + "'"];
}

void RecordCorrection::apply(Scan& scan) {
  applyToStamp(scan.t, scan.sensor_label);
  turn(scan.robot_from_lidar, scan.sensor_label);
}

void RecordCorrection::apply(OdometryReading& reading) {
  const double jump_s = corrections_.wheels_time_jump_s;
  const bool jumped = jumps_.add(kOdometry, reading.t, -jump_s);
  shift(reading.t, kOdometry, corrections_.wheels_time_offset_s + (jumped ? jump_s : 0));
  if (corrections_.wheels == WheelCorrection{}) return;
  const Pose2 read = reading.odom_from_robot;
  made_ = read_ ? *made_ * corrected(read_->inverse() * read, corrections_.wheels) : read;
  read_ = read;
  reading.odom_from_robot = *made_;
  ++counts_["odometry"];
}

void RecordCorrection::apply(CObservationDetections& detections) {
  double t = mrpt::Clock::toDouble(detections.timestamp);
  const std::string& label = detections.image_label;
  shift(t, quoted(label), offsetOf(label) + (jumps_.jumped(label) ? jumpOf(label) : 0));
  detections.timestamp = mrpt::Clock::fromDouble(t);
}

void RecordCorrection::apply(Record& record) {
  std::visit(
      [this](auto& value) {
        if constexpr (requires { *value; })
          apply(*value);
        else
          apply(value);
      },
      record);
}

}  // namespace roomgraph
