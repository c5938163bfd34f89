// SPDX-License-Identifier: BSD-3-Clause
// Options of a run: one struct per section of the configuration, and all of them together.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roomgraph/association/landmark_options.h"
#include "roomgraph/core/parameters.h"
#include "roomgraph/estimation/existence.h"
#include "roomgraph/estimation/options.h"
#include "roomgraph/mapping/occupancy_options.h"

namespace roomgraph {

/// [pipeline]
struct GeneralOptions : Configurable {
  std::vector<std::string> plugins;
  std::string objects_file;
  double lookahead_s = 0.5;
  bool set_clocks = true, set_poses = true;
  std::string calibration_file, sensor_poses;
  void declareParameters(ParameterVisitor& v) override;
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
  MotionNoise noise{0.001, 0.02, 0.0005, 0.02, 0.004, 0.01, 0.01};
  void declareParameters(ParameterVisitor& v) override;
};

/// [lidar]
struct LidarOptions : Configurable {
  bool enabled = true, loop_closing = true;
  std::string stage = "SubmapScanMatcher", label;
  MotionNoise noise{0.001, 0.01, 0.0005, 0.01, 0.003, 0.01, 0.003};
  void declareParameters(ParameterVisitor& v) override;
};

/// [odometry]
struct OdometryOptions : Configurable {
  bool enabled = true, calibrate = true;
  std::string label;
  MotionNoise noise{0.01, 0.10, 0.01, 0.15, 0.10};
  void declareParameters(ParameterVisitor& v) override;
};

/// [detection]
struct DetectionStageOptions : Configurable {
  bool enabled = true;
  std::string detector = "auto";
  int every_nth_frame = 1;
  double rate_hz = 0;
  bool track_boxes = true;
  int max_carried_frames = 5;
  void declareParameters(ParameterVisitor& v) override;
};

/// A section that holds nothing but the choice of a class, and the parameters of that class.
struct StageChoice : Configurable {
  explicit StageChoice(std::string name) : stage(std::move(name)) {}
  std::string stage;
  void declareParameters(ParameterVisitor& v) override;
};

/// The options of a run; what belongs to the class of a stage is its own.
struct Options {
  GeneralOptions general;
  RgbdOptions rgbd;
  OdometryOptions odometry;
  TrackingOptions tracking;
  LidarOptions lidar;
  StageChoice scan_loop_closing{"SubmapLoopCloser"};
  DetectionStageOptions detection;
  StageChoice ground{"DepthGroundDetector"};
  StageChoice proposals{"GeometricProposalGenerator"}, selection{"CrfSelector"}, association{"SoftAssociator"};
  LandmarkOptions landmarks;
  ExistenceOptions existence;
  ObjectLoopOptions object_loops;
  BackendOptions backend;
  OccupancyOptions mapping;
  RelocalisationOptions relocalisation;
};

}  // namespace roomgraph
