// SPDX-License-Identifier: BSD-3-Clause
// Intervals and gaps, depth quantiles, and scan rotation by beam shift.
#include "sensor_statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core/mat.hpp>

#include "flag_repair.h"
#include "frame_conversion.h"
#include "image_memory.h"
#include "roomgraph/core/order_statistics.h"
#include "roomgraph/observations/roughness.h"

namespace roomgraph {
namespace {

constexpr int kImageStride = 10;  // every n-th image is looked at for its depths,
constexpr int kPixelStride = 7;   // and in it every n-th pixel, along both axes
constexpr std::size_t kMaxScans = 20000;

// Nine tenths of the values within a few grey levels: covered, unlit or blinded.
bool isBlank(const std::string& samples) {
  constexpr int kLevels = 8;
  std::array<std::size_t, 256> histogram{};
  for (const char value : samples) ++histogram[static_cast<std::uint8_t>(value)];
  std::size_t within = 0, most = 0;
  for (std::size_t level = 0; level < histogram.size(); ++level) {
    within += histogram[level];
    if (level >= kLevels) within -= histogram[level - kLevels];
    most = std::max(most, within);
  }
  return !samples.empty() && 10 * most >= 9 * samples.size();
}

}  // namespace

void TimeStatistics::add(std::optional<double> t) {
  if (t)
    times_.push_back(*t);
  else
    ++invalid_;
}

void TimeStatistics::report(SensorReport& out) const {
  out.count = static_cast<int>(times_.size()) + invalid_;
  out.invalid_times = invalid_;
  if (times_.empty()) return;
  const auto [first, last] = std::minmax_element(times_.begin(), times_.end());
  out.first_time = *first;
  out.last_time = *last;
  if (*last > *first) out.rate_hz = static_cast<double>(times_.size() - 1) / (*last - *first);
  std::vector<double> intervals;
  for (std::size_t i = 1; i < times_.size(); ++i) {
    const double interval = times_[i] - times_[i - 1];
    intervals.push_back(interval);
    out.repeated_stamps += interval == 0;
    if (interval < 0 && out.out_of_order++ == 0) out.first_out_of_order = static_cast<int>(i);
    if (interval > out.largest_gap_s) {
      out.largest_gap_s = interval;
      out.largest_gap_time = times_[i - 1];
    }
  }
  out.median_interval_s = median(intervals);
}

void ImageStatistics::addDepth(const mrpt::obs::CObservation3DRangeScan& observation) {
  const auto& ranges = observation.rangeImage;
  for (int v = 0; v < static_cast<int>(ranges.rows()); v += kPixelStride)
    for (int u = 0; u < static_cast<int>(ranges.cols()); u += kPixelStride) {
      ++samples_;
      if (ranges(v, u) > 0) depths_m_.add(static_cast<float>(ranges(v, u)) * observation.rangeUnits);
    }
  const PointGrid grid = pointGrid(observation);
  const Pose3 robot_from_sensor = toPose3(observation.sensorPose);
  floor_.add(grid, robot_from_sensor);
  agreement_.addImage(mrpt::Clock::toDouble(observation.timestamp), grid, robot_from_sensor);
  walls_.addImage(mrpt::Clock::toDouble(observation.timestamp), grid, robot_from_sensor);
}

void ImageStatistics::add(mrpt::obs::CObservation3DRangeScan& observation, const std::string& image_folder) {
  const bool external = (observation.hasIntensityImage && observation.intensityImage.isExternallyStored()) ||
                        (observation.hasRangeImage && rangeImageIsInAFile(observation));
  if (external) {
    const std::string missing = missingExternalFile(observation, image_folder);
    ++(missing.empty() ? summary_.external_present : summary_.external_missing);
    if (!missing.empty() && summary_.first_missing.empty()) summary_.first_missing = missing;
    if (!missing.empty()) return;
  }
  summary_.color += observation.hasIntensityImage;
  summary_.depth += observation.hasRangeImage;
  const bool first = seen_++ == 0;
  const bool stride = first || seen_ % kImageStride == 0;
  if (!external) addContent(observation);
  if (!stride) return;
  loadImages(observation);
  if (external) addContent(observation);
  if (observation.hasRangeImage) addDepth(observation);
  if (first) describe(observation);
}

void ImageStatistics::addContent(const mrpt::obs::CObservation3DRangeScan& observation) {
  const double t = mrpt::Clock::toDouble(observation.timestamp);
  const auto note = [t](PoorRecords& poor) {
    if (poor.count++ == 0) poor.first_time = t;
  };
  ++summary_.looked_at;
  repetition_.add(t, contentOf(observation));
  if (observation.hasIntensityImage && !observation.intensityImage.isEmpty() &&
      isBlank(samplesOf(observation.intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY))))
    note(summary_.blank);
  if (!observation.hasRangeImage || observation.rangeImage.size() == 0) return;
  std::vector<float> samples_m;
  bool any = false;
  const auto& ranges = observation.rangeImage;
  for (int v = 0; v < static_cast<int>(ranges.rows()); v += kPixelStride)
    for (int u = 0; u < static_cast<int>(ranges.cols()); u += kPixelStride) {
      any = any || ranges(v, u) > 0;
      samples_m.push_back(static_cast<float>(ranges(v, u)) * observation.rangeUnits);
    }
  if (any)
    roughness_.add(t, roughnessOf(samples_m));
  else
    note(summary_.without_depth);
}

void ImageStatistics::describe(const mrpt::obs::CObservation3DRangeScan& observation) {
  const auto& ranges = observation.rangeImage;
  summary_.depth_width = static_cast<int>(ranges.cols());
  summary_.depth_height = static_cast<int>(ranges.rows());
  if (observation.hasIntensityImage) {
    summary_.color_width = static_cast<int>(observation.intensityImage.getWidth());
    summary_.color_height = static_cast<int>(observation.intensityImage.getHeight());
  }
  summary_.color_camera =
      cameraForImage(observation.cameraParamsIntensity, summary_.color_width, summary_.color_height);
  summary_.depth_camera =
      cameraForImage(observation.cameraParams, summary_.depth_width, summary_.depth_height);
  if (summary_.color_width > 0) summary_.color_distortion = distortionOf(observation.cameraParamsIntensity);
  if (summary_.depth_width > 0) summary_.depth_distortion = distortionOf(observation.cameraParams);
  summary_.registered = depthIsRegistered(observation, summary_.color_camera, summary_.depth_camera);
  summary_.range_is_depth = observation.range_is_depth;
  summary_.depth_unit_m = observation.rangeUnits;
}

ImageSummary ImageStatistics::report() const {
  ImageSummary out = summary_;
  out.median_depth_m = depths_m_.quantile(0.5);
  out.near_depth_m = depths_m_.quantile(0.05);
  out.far_depth_m = depths_m_.quantile(0.95);
  out.floor = floor_.report();
  out.floor_spread = floor_.spread();
  out.noisy = roughness_.noisy();
  out.same = repetition_.longest();
  out.range_over_lidar = agreement_.ratio();
  out.walls_off_m = walls_.distance();
  if (samples_ > 0)
    out.valid_depth_share = static_cast<double>(depths_m_.size()) / static_cast<double>(samples_);
  return out;
}

void ScanStatistics::add(const mrpt::obs::CObservation2DRangeScan& observation) {
  Stamped scan{mrpt::Clock::toDouble(observation.timestamp), {}};
  const std::size_t beams = observation.getScanSize();
  if (scans_.empty()) {
    summary_.beams = static_cast<int>(beams);
    summary_.aperture_rad = observation.aperture;
    summary_.max_range_m = observation.maxRange;
    summary_.right_to_left = observation.rightToLeft;
    summary_.upside_down = toPose3(observation.sensorPose).linear()(2, 2) < 0;
  }
  summary_.beams_change = summary_.beams_change || static_cast<int>(beams) != summary_.beams;
  scan.ranges_m.resize(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const float range = observation.getScanRange(i);
    const bool at_max = observation.maxRange > 0 && range >= 0.999f * observation.maxRange;
    const bool valid = observation.getScanRangeValidity(i) && std::isfinite(range) && range > 0 && !at_max;
    summary_.not_finite += observation.getScanRangeValidity(i) && !std::isfinite(range);
    at_max_ += at_max;
    valid_ += valid;
    scan.ranges_m[i] = valid ? range : 0.f;
  }
  beams_ += beams;
  roughness_.add(scan.t, roughnessOfScan(scan.ranges_m));
  if (hasReturn(observation)) repetition_.add(scan.t, contentOf(observation));
  if (scans_.size() < kMaxScans) scans_.push_back(std::move(scan));
}

ScanSummary ScanStatistics::report(const Trajectory& odometry) const {
  ScanSummary out = summary_;
  if (beams_ > 0) {
    out.valid_share = static_cast<double>(valid_) / static_cast<double>(beams_);
    out.at_max_share = static_cast<double>(at_max_) / static_cast<double>(beams_);
  }
  for (const auto& scan : scans_)
    out.largest_change_m = std::max(out.largest_change_m, difference(scans_.front(), scan));
  out.noisy = roughness_.noisy();
  out.same = repetition_.longest();
  out.rotation_ratio = rotationRatio(odometry);
  return out;
}

// Mean over the beams that return in both; 0 when there are none.
double ScanStatistics::difference(const Stamped& a, const Stamped& b) {
  double sum = 0;
  int both = 0;
  for (std::size_t i = 0; i < std::min(a.ranges_m.size(), b.ranges_m.size()); ++i)
    if (a.ranges_m[i] > 0 && b.ranges_m[i] > 0) {
      sum += std::abs(a.ranges_m[i] - b.ranges_m[i]);
      ++both;
    }
  return both > 0 ? sum / both : 0;
}

double ScanStatistics::change(double from, double to) const {
  const Stamped *first = nullptr, *last = nullptr;
  for (const auto& scan : scans_) {
    if (scan.t <= from) first = &scan;
    if (scan.t <= to) last = &scan;
  }
  return first && last ? difference(*first, *last) : 0;
}

std::optional<double> ScanStatistics::rotationRatio(const Trajectory& odometry) const {
  constexpr double kLeastTurn = 0.1, kLargestTurn = 0.5;  // rad
  constexpr double kLargestMove = 0.08;                   // m: more would change the ranges themselves
  constexpr double kMovePerTurn = 0.3;                    // m/rad: walls beside an arc turn by other angles than the robot
  constexpr std::size_t kLeastPairs = 5, kMostPairs = 200;
  constexpr double kDiffers = 0.1, kAgrees = 0.08;
  if (odometry.size() < 2 || summary_.beams < 30 || !(summary_.aperture_rad > 0)) return std::nullopt;
  const double step = summary_.aperture_rad / (summary_.beams - 1);
  const double direction = summary_.right_to_left != summary_.upside_down ? 1 : -1;
  std::vector<double> ratios;
  for (std::size_t i = 0, j = 1; j < scans_.size() && ratios.size() < kMostPairs; ++j) {
    const auto moved = odometry.between(scans_[i].t, scans_[j].t);
    const double turn = moved ? std::abs(planarPart(*moved).yaw) : 0;
    if (!moved || moved->translation().norm() > kLargestMove || turn > kLargestTurn) {
      i = j;
      continue;
    }
    if (turn < kLeastTurn || moved->translation().norm() > kMovePerTurn * turn) continue;
    // Twice the turn in both directions leaves room for an aperture that is wrong by a factor of two.
    const auto shift = beamShift(scans_[i].ranges_m, scans_[j].ranges_m,
                                 static_cast<int>(std::min(2.5 * turn / step, 1.0 * summary_.beams)));
    if (shift && *shift != 0) ratios.push_back(direction * planarPart(*moved).yaw / (*shift * step));
    i = j;
  }
  if (ratios.size() < kLeastPairs) return std::nullopt;
  // Arcs close to walls change ranges as turns do: some ratios are wrong by that, but hardly three quarters of them.
  const double middle = median(ratios);
  if (middle > 1 + kDiffers && quantile(ratios, 0.25) < 1 + kAgrees) return std::nullopt;
  if (middle > 0 && middle < 1 - kDiffers && quantile(ratios, 0.75) > 1 - kAgrees) return std::nullopt;
  return middle;
}

std::optional<double> beamShift(const std::vector<float>& before, const std::vector<float>& after,
                                int largest_shift) {
  const int count = static_cast<int>(std::min(before.size(), after.size()));
  constexpr double kLargestMismatch = 0.1;  // m per beam, robust
  double best = kLargestMismatch;
  std::optional<double> found;
  for (int shift = -largest_shift; shift <= largest_shift; ++shift) {
    double sum = 0;
    int both = 0;
    for (int i = std::max(0, -shift); i < std::min(count, count - shift); ++i) {
      const float a = before[static_cast<std::size_t>(i + shift)], b = after[static_cast<std::size_t>(i)];
      if (a <= 0 || b <= 0) continue;
      sum += std::min(0.5f, std::abs(a - b));
      ++both;
    }
    if (both < count / 3 || sum / both >= best) continue;
    best = sum / both;
    found = shift;
  }
  return found;
}

}  // namespace roomgraph
