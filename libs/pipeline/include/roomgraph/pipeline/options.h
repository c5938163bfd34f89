// SPDX-License-Identifier: BSD-3-Clause
// Options of the pipeline's configuration sections.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/association/constellation.h"
#include "roomgraph/core/parameters.h"
#include "roomgraph/detection/box_tracker.h"

namespace roomgraph {

/// [pipeline]
struct GeneralOptions : Configurable {
  std::vector<std::string> plugins;
  std::string objects_file;
  double lookahead_s = 0.5;
  std::string sensor_poses;
  void declareParameters(ParameterVisitor& v) override;
};

/// What a source of motion is trusted with: standard deviations grow with the movement.
struct MotionNoise {
  double floor_m = 0.01, per_m = 0.02;       ///< translation
  double floor_rad = 0.003, per_rad = 0.02;  ///< rotation
  double rad_per_m = 0.01;                   ///< rotation, by distance driven
  void declare(ParameterVisitor& v);
};

/// [rgbd]
struct RgbdOptions : Configurable {
  std::string label;
  void declareParameters(ParameterVisitor& v) override;
};

/// [tracking]
struct TrackingOptions : Configurable {
  bool enabled = true, loop_closing = true;
  std::string stage = "FeatureOdometry";
  MotionNoise noise{0.004, 0.02, 0.002, 0.02, 0.004};
  void declareParameters(ParameterVisitor& v) override;
};

/// [lidar]
struct LidarOptions : Configurable {
  bool enabled = true, loop_closing = true;
  std::string stage = "SubmapScanMatcher", label;
  MotionNoise noise{0.004, 0.01, 0.002, 0.01, 0.003};
  void declareParameters(ParameterVisitor& v) override;
};

/// [odometry]
struct OdometryOptions : Configurable {
  bool enabled = true;
  std::string label;
  MotionNoise noise{0.01, 0.10, 0.01, 0.15, 0.10};
  void declareParameters(ParameterVisitor& v) override;
};

/// [detection]
struct DetectionStageOptions : Configurable {
  bool enabled = true;
  std::string detector = "auto";
  int every_nth_frame = 1;
  bool track_boxes = true;
  int max_carried_frames = 5;
  void declareParameters(ParameterVisitor& v) override;
};

/// [scan_loop_closing], [proposals], [selection], [association]
struct StageChoice : Configurable {
  explicit StageChoice(std::string name) : stage(std::move(name)) {}
  std::string stage;
  void declareParameters(ParameterVisitor& v) override;
};

/// [backend]
struct BackendOptions : Configurable {
  double node_distance_m = 0.15, node_angle_rad = 0.15, node_interval_s = 5;
  int window_nodes = 10, optimize_every_nodes = 20, max_iterations = 30;
  double live_tolerance = 1e-4;
  double urgent_closure_m = 0.1, urgent_closure_rad = 0.03;
  double closure_robust_width = 1.0, landmark_robust_width = 1.0;
  double planar_sigma_z_m = 0.01, planar_sigma_tilt_rad = 0.005;
  double ground_sigma_rad = 0.02, ground_sigma_m = 0.02;
  double pose_sigma_m = 0.03;
  double landmark_information_share = 0.01;
  double landmark_side_rad = 0.26;
  bool object_boxes = true;
  bool planar_graph = false;
  double box_sigma_px = 60, point_sigma_px = 20;
  int points_per_landmark = 10;
  void declareParameters(ParameterVisitor& v) override;
};

/// [object_loop_closing]
struct ObjectLoopOptions : Configurable {
  bool enabled = true;
  double recent_s = 40;
  int every_nodes = 5;
  double min_shift_m = 0.3;
  ConstellationOptions constellation;
  void declareParameters(ParameterVisitor& v) override;
};

}  // namespace roomgraph
