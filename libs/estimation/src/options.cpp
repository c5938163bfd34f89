// SPDX-License-Identifier: BSD-3-Clause
// Declarations of the parameters of [backend], [object_loop_closing] and the noise of motion sources.
#include "roomgraph/estimation/options.h"

namespace roomgraph {

void MotionNoise::declare(ParameterVisitor& v) {
  v.add("noise_floor_m", floor_m, {.doc = "translation noise at rest", .unit = "m", .min = 1e-5, .max = 1});
  v.add("noise_per_m", per_m, {.doc = "translation noise per distance", .min = 0, .max = 1});
  v.add("noise_floor_rad", floor_rad,
        {.doc = "rotation noise at rest", .unit = "rad", .min = 1e-5, .max = 1});
  v.add("noise_per_rad", per_rad, {.doc = "rotation noise per angle turned", .min = 0, .max = 1});
  v.add("noise_rad_per_m", rad_per_m,
        {.doc = "rotation noise per distance", .unit = "rad/m", .min = 0, .max = 1});
}

namespace {

void declareObjectFactors(BackendOptions& o, ParameterVisitor& v) {
  v.add("object_boxes", o.object_boxes,
        {.doc = "whether the boxes of objects and their usual sizes are factors of the graph"});
  v.add("box_sigma_px", o.box_sigma_px,
        {.doc = "of the sides of a box against the projected model", .unit = "px", .min = 0.1, .max = 1000});
  v.add("points_per_landmark", o.points_per_landmark,
        {.doc = "tracked points that tie a landmark to the poses that saw them; 0: none",
         .min = 0,
         .max = 10000});
  v.add("point_sigma_px", o.point_sigma_px,
        {.doc = "of such a point in the image", .unit = "px", .min = 0.1, .max = 100});
  v.add("landmark_information_share", o.landmark_information_share,
        {.doc = "share of a sighting's information that counts: sightings in a row share their errors",
         .min = 1e-4,
         .max = 1});
  v.add("landmark_side_rad", o.landmark_side_rad,
        {.doc = "directions of view that share an error: a side", .unit = "rad", .min = 0.01, .max = 6.3});
}

}  // namespace

void BackendOptions::declareParameters(ParameterVisitor& v) {
  v.add("node_distance_m", node_distance_m,
        {.doc = "movement that makes a new pose of the graph", .unit = "m", .min = 0.01, .max = 10});
  v.add("node_angle_rad", node_angle_rad,
        {.doc = "turn that makes a new pose of the graph", .unit = "rad", .min = 0.01, .max = 3.2});
  v.add("node_interval_s", node_interval_s,
        {.doc = "time that makes a new pose of the graph", .unit = "s", .min = 0.1, .max = 1000});
  v.add("window_nodes", window_nodes,
        {.doc = "latest poses optimised with every new one", .min = 2, .max = 100});
  v.add("optimize_every_nodes", optimize_every_nodes,
        {.doc = "new poses between two optimisations of the whole graph", .min = 1, .max = 100000});
  v.add("urgent_closure_m", urgent_closure_m,
        {.doc = "a loop closure this far off the estimate is optimised soon",
         .unit = "m",
         .min = 0,
         .max = 100});
  v.add("urgent_closure_rad", urgent_closure_rad,
        {.doc = "a loop closure this far off the estimate is optimised soon",
         .unit = "rad",
         .min = 0,
         .max = 3.2});
  v.add("max_iterations", max_iterations, {.doc = "of one optimisation", .min = 1, .max = 1000});
  v.add("live_tolerance", live_tolerance,
        {.doc = "change of the cost that ends an optimisation of the whole graph during the run",
         .min = 1e-12,
         .max = 0.1});
  v.add("closure_robust_width", closure_robust_width,
        {.doc = "Cauchy width for loop closures, in standard deviations; 0: least squares",
         .min = 0,
         .max = 100});
  v.add("landmark_robust_width", landmark_robust_width,
        {.doc = "Cauchy width for object sightings, in standard deviations; 0: least squares",
         .min = 0,
         .max = 100});
  v.add("planar_sigma_z_m", planar_sigma_z_m,
        {.doc = "height of a ground robot above the floor", .unit = "m", .min = 1e-5, .max = 10});
  v.add("planar_sigma_tilt_rad", planar_sigma_tilt_rad,
        {.doc = "roll and pitch of a ground robot", .unit = "rad", .min = 1e-5, .max = 3});
  v.add("ground_sigma_rad", ground_sigma_rad,
        {.doc = "normal of the floor as a handheld camera sees it", .unit = "rad", .min = 1e-4, .max = 3});
  v.add("ground_sigma_m", ground_sigma_m,
        {.doc = "distance of the floor as a handheld camera sees it", .unit = "m", .min = 1e-4, .max = 10});
  v.add("pose_sigma_m", pose_sigma_m,
        {.doc = "uncertainty of the current pose when objects are associated",
         .unit = "m",
         .min = 0,
         .max = 10});
  declareObjectFactors(*this, v);
  v.add(
      "planar_graph", planar_graph,
      {.doc = "write graph.g2o in 2D (SE2) when the robot drives on a floor; a handheld camera's stays 3D"});
}

void ObjectLoopOptions::declareParameters(ParameterVisitor& v) {
  v.add("enabled", enabled, {.doc = "whether objects propose loop closures"});
  v.add("recent_s", recent_s,
        {.doc = "landmarks first seen this long ago at most are compared with older ones",
         .unit = "s",
         .min = 1,
         .max = 10000});
  v.add("every_nodes", every_nodes, {.doc = "new poses between two searches", .min = 1, .max = 100000});
  v.add("min_shift_m", min_shift_m,
        {.doc = "a smaller disagreement is left to the association", .unit = "m", .min = 0, .max = 100});
  v.add("min_pairs", constellation.min_pairs,
        {.doc = "objects that two constellations must have in common", .min = 3, .max = 100});
  v.add("tolerance_m", constellation.tolerance_m,
        {.doc = "distance of two objects that lie on each other", .unit = "m", .min = 0.01, .max = 5});
  v.add("min_lead", constellation.min_lead,
        {.doc = "pairs more than the best other way to lay them on each other", .min = 0, .max = 100});
}

}  // namespace roomgraph
