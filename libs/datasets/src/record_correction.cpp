// SPDX-License-Identifier: BSD-3-Clause
// Shifted stamps, corrected depths, odometry summed up again from corrected movements.
#include "record_correction.h"

#include <mrpt/core/Clock.h>

#include <cstdio>

namespace roomgraph {

void RecordCorrection::shift(double& t, const std::string& label) {
  const auto offset = corrections_.time_offsets_s.find(label);
  if (offset == corrections_.time_offsets_s.end() || offset->second == 0) return;
  t += offset->second;
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%+.4f s", offset->second);
  ++counts_["stamp of '" + label + "' " + seconds];
}

void RecordCorrection::apply(Frame& frame) {
  shift(frame.t, frame.sensor_label);
  if (corrections_.depth == DepthCorrection{} || !frame.hasDepth()) return;
  frame.depth = frame.depth.clone();
  for (float& z : cv::Mat_<float>(frame.depth))
    if (z > 0)
      z = std::max(0.f, static_cast<float>(corrections_.depth.scale * z + corrections_.depth.bias_m));
  ++counts_["depth of '" + frame.sensor_label + "'"];
}

void RecordCorrection::apply(Scan& scan) {
  shift(scan.t, scan.sensor_label);
}

void RecordCorrection::apply(OdometryReading& reading) {
  reading.t += corrections_.wheels_time_offset_s;
  if (corrections_.wheels_time_offset_s != 0) ++counts_["stamp of odometry"];
  if (corrections_.wheels == WheelCorrection{}) return;
  const Pose2 read = reading.odom_from_robot;
  made_ = read_ ? *made_ * corrected(read_->inverse() * read, corrections_.wheels) : read;
  read_ = read;
  reading.odom_from_robot = *made_;
  ++counts_["odometry"];
}

void RecordCorrection::apply(CObservationDetections& detections) {
  double t = mrpt::Clock::toDouble(detections.timestamp);
  shift(t, detections.image_label);
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
