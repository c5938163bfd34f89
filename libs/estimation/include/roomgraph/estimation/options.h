// SPDX-License-Identifier: BSD-3-Clause
// Options of the estimation: noise of the motion sources, factor graph, loop closing by objects.
#pragma once

#include "roomgraph/association/constellation.h"
#include "roomgraph/core/parameters.h"

namespace roomgraph {

/// Noise model of a source of motion: standard deviations that grow with the movement.
struct MotionNoise {
  double floor_m = 0.01, per_m = 0.02;       ///< translation
  double floor_rad = 0.003, per_rad = 0.02;  ///< rotation
  double rad_per_m = 0.01;                   ///< rotation, by distance driven
  /// Of a source that is matched against local maps: shares of the variance of single movements, of their translation
  /// and of their rotation, that add up from one local map to the next.
  double drift_share = 1, drift_share_rotation = 1;
  void declare(ParameterVisitor& v);
  void declareDrift(ParameterVisitor& v);
};

/// [backend]
struct BackendOptions : Configurable {
  double node_distance_m = 0.15, node_angle_rad = 0.15, node_interval_s = 5;
  int window_nodes = 10, optimize_every_nodes = 10, max_iterations = 30;
  int local_map_nodes = 10, free_nodes = 100;
  int views_kept = 1000;
  double live_tolerance = 1e-4, final_tolerance = 1e-6;
  double urgent_closure_m = 0.1, urgent_closure_rad = 0.03;
  double closure_robust_width = 1.0, landmark_robust_width = 1.0;
  double planar_sigma_z_m = 0.01, planar_sigma_tilt_rad = 0.005;
  double ground_sigma_rad = 0.02, ground_sigma_m = 0.02;
  double pose_sigma_m = 0.03;
  double landmark_sigma_share = 0.5;
  double landmark_repeating_share = 0.5;
  double landmark_view_rad = 0.26;
  bool object_boxes = true, object_sizes = true, object_views = true, object_sides = true;
  bool points_inside = true, objects_on_floor = true;
  bool planar_graph = false;
  double box_sigma = 0.06, point_sigma_px = 10, side_sigma_m = 0.05;
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

/// [relocalisation]
struct RelocalisationOptions : Configurable {
  int views = 100, view_corners = 200;
  double view_distance_m = 1, view_angle_rad = 0.7;
  double min_explained = 0.75, max_contradicted = 0.1, ambiguity_ratio = 0.85;
  double tolerance_m = 0.25, tolerance_rad = 0.08, recent_s = 15;
  int agreeing = 3, agreeing_alone = 5;
  double alone_s = 3, alone_m = 1, rival_share = 0.25;
  double fix_distance_m = 0.3;
  void declareParameters(ParameterVisitor& v) override;
};

}  // namespace roomgraph
