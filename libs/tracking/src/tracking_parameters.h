// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the feature odometry.
#pragma once

#include "roomgraph/core/parameters.h"

namespace roomgraph {

/// Parameters of FeatureOdometry; units and meaning stand in the declaration (tracking_parameters.cpp).
struct TrackingParameters : Configurable {
  // features
  int max_features = 1000;
  int pyramid_levels = 8;
  double scale_factor = 1.2;
  int fast_threshold = 7;
  int cell_px = 32;
  // measurement noise
  double pixel_sigma_px = 1.0;
  double depth_sigma_base_m = 0.002;
  double depth_sigma_quadratic = 0.0025;
  double max_depth_m = 8.0;
  double max_depth_step = 0.05;
  // matching
  double search_radius_px = 20;
  double local_map_radius_px = 4;
  int max_hamming = 80;
  double match_ratio = 0.85;
  int min_inliers = 20;
  // keyframes
  double keyframe_inlier_ratio = 0.75;
  double keyframe_distance_m = 0.25;
  double keyframe_angle_rad = 0.30;
  int local_keyframes = 12;
  int keyframes_kept = 400;
  // bundle adjustment
  int ba_window = 8;
  int ba_fixed_keyframes = 10;
  int ba_iterations = 6;
  // recovery
  int relocalisation_frames = 5;
  int relocalisation_candidates = 8;
  int relocalisation_min_inliers = 30;
  bool dense_alignment = true;
  // loop closing
  int loop_candidates = 2;
  int loop_min_gap = 15;
  int loop_min_inliers = 40;
  // covariance of steps and loop closures
  double covariance_scale = 4;
  double min_step_sigma_m = 0.003;
  double min_step_sigma_rad = 0.002;
  double min_loop_sigma_m = 0.02;
  double min_loop_sigma_rad = 0.01;

  void declareParameters(ParameterVisitor& visitor) override;
};

}  // namespace roomgraph
