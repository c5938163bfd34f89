// SPDX-License-Identifier: BSD-3-Clause
// Sensor models of the simulation: depth, colour, lidar, odometry and detector.
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>

#include <opencv2/core/mat.hpp>
#include <vector>

#include "id_raster.h"
#include "roomgraph/core/random.h"
#include "roomgraph/observations/CObservationDetections.h"
#include "roomgraph/simulation/world.h"
#include "scene.h"

namespace roomgraph {

/// Measurement model of a structured-light depth camera, from exact depth (CV_32F, m) to CV_16U, mm, 0 =
/// no measurement. Noise sigma = 0.0012 + 0.0019 (z - 0.4)^2 m (Nguyen et al. 2012), alike within some
/// pixels; disparity in steps; missing beyond the range, in the projector's shadow and at many depth
/// edges.
cv::Mat measureDepth(const cv::Mat& depth, const CameraSpec& spec, Random random);

/// Exposure, vignetting and noise of a cheap colour camera; `light` as ambientLight() gives it.
cv::Mat measureColor(const cv::Mat& color, const cv::Mat& light, const CameraSpec& spec, Random random);

/// Piece of an outline at the lidar's height, in world.
struct Segment {
  Eigen::Vector2d a, b;
};

/// Cuts the scene with a horizontal plane: rays within it are then cast on segments, exactly.
class LidarCaster {
 public:
  LidarCaster(const Scene& scene, double height_m);
  /// Distance to the first surface in every beam's direction; infinite where there is none. Beam i points at
  /// -pi + i 2 pi / (beams - 1) relative to `world_from_lidar`.
  std::vector<double> cast(const Pose2& world_from_lidar, int beams, double seconds) const;
  /// Outlines of all but people, with furniture where it stands then.
  std::vector<Segment> furnishedOutlines(double seconds) const;

 private:
  const Scene& scene_;
  double height_m_;
  std::vector<Segment> fixed_;
};

/// The scan as the sensor reports it: noise, dropouts, range limits.
mrpt::obs::CObservation2DRangeScan measureScan(const std::vector<double>& distances, const LidarSpec& spec,
                                               Random random);

/// Wheel odometry: pose in the drifting frame that starts at 0, one per instant of `truth`.
std::vector<Pose2> measureOdometry(const std::vector<Pose2>& truth, const OdometrySpec& spec, Random random);

/// Model of an object detector: bounding boxes with jitter, missed detections, false positives and wrong
/// labels (COCO names).
CObservationDetections measureDetections(const std::vector<ObjectView>& views, const Scene& scene,
                                         const PinholeCamera& camera, const DetectionsSpec& spec,
                                         Random random);

}  // namespace roomgraph
