// SPDX-License-Identifier: BSD-3-Clause
// Corrections of a calibration file applied to the records of a recording as they are read.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/datasets/calibration_file.h"
#include "roomgraph/datasets/record_stream.h"
#include "stamp_jumps.h"

namespace roomgraph {

/// Corrects records one after the other. Remembers what wheel odometry was and has become.
class RecordCorrection {
 public:
  explicit RecordCorrection(RecordCorrections corrections) : corrections_(std::move(corrections)) {}

  /// Stamp, pose on the robot, depths or odometry; recorded boxes move with the images that they belong to.
  void apply(Record& record);
  /// Records that were changed, by what was changed.
  const std::map<std::string, int>& counts() const { return counts_; }
  /// Of stamps as they were read.
  const StampJumpsBySensor& jumps() const { return jumps_.found(); }

 private:
  double offsetOf(const std::string& label) const;
  double jumpOf(const std::string& label) const;
  void applyToStamp(double& t, const std::string& label);
  void shift(double& t, const std::string& sensor, double seconds);
  void turn(Pose3& robot_from_sensor, const std::string& label);
  void apply(Frame& frame);
  void apply(Scan& scan);
  void apply(OdometryReading& reading);
  void apply(CObservationDetections& detections);

  RecordCorrections corrections_;
  StampJumps jumps_;
  std::optional<Pose2> read_, made_;  ///< the last odometry pose, and what it has become
  std::map<std::string, int> counts_;
};

}  // namespace roomgraph
