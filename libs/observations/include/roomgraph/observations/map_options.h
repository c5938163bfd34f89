// SPDX-License-Identifier: BSD-3-Clause
// Options of the semantic map as a metric map of MRPT: insertion and likelihood of observations.
#pragma once

#include "roomgraph/core/parameters.h"
#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Options of the likelihood of scans and detections (method.md sec. 6.1).
struct MapLikelihoodOptions : Configurable {
  bool use_grid = true, use_objects = true;
  int camera_width = 0, camera_height = 0;  ///< px; 0: camera not known
  double camera_fx = 0, camera_fy = 0, camera_cx = 0, camera_cy = 0;
  double camera_x = 0, camera_y = 0, camera_z = 0;                       ///< on the robot, m
  double camera_yaw_deg = 0, camera_pitch_deg = 0, camera_roll_deg = 0;  ///< of an x-forward frame
  double detection_probability = 0.8;
  double clutter_boxes = 0.5;
  double box_sigma = 0.06;
  double side_sigma_px = 2;
  double hidden_side = 0.2;
  double wrong_label = 0.05;
  double behind_walls = 0.1;
  double near_m = 0.4, far_m = 6;
  double tempering = 0.5;

  void declareParameters(ParameterVisitor& visitor) override;
  /// Camera of an image of this size; not valid when the options name none or one of another shape.
  PinholeCamera cameraOf(int width, int height) const;
  /// Optical frame.
  Pose3 robotFromCamera() const;
};

/// Options of insertObservation(); the grid has more of its own.
struct MapInsertionOptions : Configurable {
  double grid_resolution_m = 0.05;
  bool insert_objects = true;
  double new_object_score = 0.5;
  double gate_sigma = 3;

  void declareParameters(ParameterVisitor& visitor) override;
};

}  // namespace roomgraph
