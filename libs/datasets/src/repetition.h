// SPDX-License-Identifier: BSD-3-Clause
// Records in a row whose content is the same: a sensor that hangs.
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "roomgraph/datasets/rawlog_report.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Finds runs of records in a row with the same content. Real sensors have noise: even before a wall no two
/// of their records are the same.
class Repetition {
 public:
  /// A record at time t (s); `content` is what tells it from others.
  void add(double t, std::string_view content);
  /// The run that lasts longest; of two with one length the first.
  const SameRecords& longest() const { return longest_; }
  /// Of the run that the last record belongs to.
  const SameRecords& current() const { return current_; }

 private:
  SameRecords longest_, current_;
  std::size_t hash_ = 0;
};

/// Tells when a sensor hangs: the same record again, though the wheels say that the robot has moved since the first of them. The second time will do
/// of a sensor whose records have changed five times before, else the fifth. A simulated sensor without noise repeats itself wherever the robot stands.
/// Without wheels it hangs as well, when its records have changed twenty times before: at rest the same record is not missed.
class HangingSensor {
 public:
  /// A record at time t (s), and where the wheels have the robot then, if they say so; whether the sensor hangs.
  bool hangs(double t, std::string_view content, const std::optional<Pose2>& wheels);

 private:
  Repetition same_;
  std::optional<Pose2> wheels_before_;  ///< at the first record of the run
  int changes_ = 0;
};

/// Whether there is a return. Scans of which none has are the same without a fault: there is nothing within range.
bool hasReturn(const mrpt::obs::CObservation2DRangeScan& scan);

/// Every n-th pixel of an image along both axes, all channels.
std::string samplesOf(const cv::Mat& image);

/// What tells records from others: all ranges and whether they are valid; samples of colour and depth, which
/// must be loaded.
std::string contentOf(const mrpt::obs::CObservation2DRangeScan& scan);
std::string contentOf(const mrpt::obs::CObservation3DRangeScan& images);

}  // namespace roomgraph
