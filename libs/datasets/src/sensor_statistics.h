// SPDX-License-Identifier: BSD-3-Clause
// Statistics of one sensor: stamps, depth images, scans and their rotation against odometry.
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <memory>
#include <string>
#include <vector>

#include "floor_statistics.h"
#include "log_histogram.h"
#include "point_grid.h"
#include "range_agreement.h"
#include "repetition.h"
#include "roomgraph/datasets/rawlog_report.h"
#include "roomgraph/observations/trajectory.h"
#include "roughness_watch.h"
#include "scan_agreement.h"

namespace roomgraph {

/// Stamps of one sensor in file order.
class TimeStatistics {
 public:
  void add(std::optional<double> t);
  void report(SensorReport& out) const;

 private:
  std::vector<double> times_;
  int invalid_ = 0;
};

class ImageStatistics {
 public:
  void add(mrpt::obs::CObservation3DRangeScan& observation, const std::string& image_folder);
  /// Something else to compare the depth with. In the order of the file, between the images.
  void addScan(const Scan& scan) {
    agreement_.addScan(scan);
    walls_.addScan(scan);
  }
  ImageSummary report() const;

 private:
  void describe(const mrpt::obs::CObservation3DRangeScan& observation);  ///< of the first record
  void addDepth(const mrpt::obs::CObservation3DRangeScan& observation);
  void addContent(const mrpt::obs::CObservation3DRangeScan& observation);
  ImageSummary summary_;
  Repetition repetition_;
  RoughnessWatch roughness_;
  FloorStatistics floor_;
  RangeAgreement agreement_;
  ScanAgreement walls_;
  LogHistogram depths_m_;  ///< samples of the valid ones
  std::size_t samples_ = 0;
  int seen_ = 0;
};

class ScanStatistics {
 public:
  void add(const mrpt::obs::CObservation2DRangeScan& observation);
  /// `odometry` may be empty.
  ScanSummary report(const Trajectory& odometry) const;
  /// Mean difference per beam between the last scans before these instants (s), m; 0 when there are none.
  double change(double from, double to) const;

 private:
  struct Stamped {
    double t;
    std::vector<float> ranges_m;  ///< 0: no return
  };
  std::optional<double> rotationRatio(const Trajectory& odometry) const;
  static double difference(const Stamped& a, const Stamped& b);
  ScanSummary summary_;
  Repetition repetition_;
  RoughnessWatch roughness_;
  std::vector<Stamped> scans_;
  std::size_t beams_ = 0, valid_ = 0, at_max_ = 0;
};

/// Rotation between two scans of the same place as a number of beams, found by shifting one over the other:
/// range of beam i + shift in `before` equals that of beam i in `after`. Nothing when they do not match well.
std::optional<double> beamShift(const std::vector<float>& before, const std::vector<float>& after,
                                int largest_shift);

}  // namespace roomgraph
