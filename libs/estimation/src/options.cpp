// SPDX-License-Identifier: BSD-3-Clause
// Declarations of the parameters of [backend], [object_loop_closing] and the noise of motion sources.
#include "roomgraph/estimation/options.h"

namespace roomgraph {

void MotionNoise::declare(ParameterVisitor& v) {
  v.add("noise_floor_m", floor_m,
        {.doc = "Standard deviation of a movement's translation when the robot stands "
                "still.",
         .unit = "m",
         .min = 1e-5,
         .max = 1});
  v.add("noise_per_m", per_m,
        {.doc = "Growth of the translation's standard deviation per metre driven.", .min = 0, .max = 1});
  v.add("noise_floor_rad", floor_rad,
        {.doc = "Standard deviation of a movement's rotation when the robot stands still.",
         .unit = "rad",
         .min = 1e-5,
         .max = 1});
  v.add("noise_per_rad", per_rad,
        {.doc = "Growth of the rotation's standard deviation per radian turned.", .min = 0, .max = 1});
  v.add("noise_rad_per_m", rad_per_m,
        {.doc = "Growth of the rotation's standard deviation per metre driven.",
         .unit = "rad/m",
         .min = 0,
         .max = 1});
}

void MotionNoise::declareDrift(ParameterVisitor& v) {
  v.add("drift_share", drift_share,
        {.doc = "Share of the variance of single movements' translation that adds up from one local map ([backend] "
                "local_map_nodes) to the next.",
         .min = 1e-6,
         .max = 1});
  v.add("drift_share_rotation", drift_share_rotation,
        {.doc = "The same share of the variance of their rotation.", .min = 1e-6, .max = 1});
}

namespace {

// When key poses are made, and when which of them are optimised.
void declareKeyPoses(BackendOptions& o, ParameterVisitor& v) {
  v.add("node_distance_m", o.node_distance_m,
        {.doc = "A new key pose is made after this movement.", .unit = "m", .min = 0.01, .max = 10});
  v.add("node_angle_rad", o.node_angle_rad,
        {.doc = "A new key pose is made after this turn.", .unit = "rad", .min = 0.01, .max = 3.2});
  v.add("node_interval_s", o.node_interval_s,
        {.doc = "A new key pose is made after this time.", .unit = "s", .min = 0.1, .max = 1000});
  v.add("window_nodes", o.window_nodes,
        {.doc = "Key poses in the sliding window, which is optimised with every new one.",
         .min = 2,
         .max = 100});
  v.add(
      "local_map_nodes", o.local_map_nodes,
      {.doc =
           "Key poses that images, and scans, measure against one local map, whose pose is a variable: their "
           "errors do not add up within it. 0: each movement is measured for itself.",
       .min = 0,
       .max = 1000});
  v.add("free_nodes", o.free_nodes,
        {.doc = "So many latest key poses, and all that were in none before, have a pose of their own in optimisations of the "
                "whole graph during a run; older ones move rigidly with the first one of their ten, or of more where they are more than a "
                "thousand back. At its end all have, in the first optimisation and in the last, if they are not more than 2000.",
         .min = 1,
         .max = 1000000});
  v.add("views_kept", o.views_kept,
        {.doc = "When there are more images with objects in them, reduced depth images, scans and slices for the grid, or views for "
                "relocalisation, those are given up that repeat others from that place in that direction: memory grows with the "
                "area seen.",
         .min = 0,
         .max = 100000000});
  v.add("optimize_every_nodes", o.optimize_every_nodes,
        {.doc = "Key poses between two optimisations of the whole graph.", .min = 1, .max = 100000});
  v.add("urgent_closure_m", o.urgent_closure_m,
        {.doc = "After a loop closure that differs more from the estimate the whole graph is optimised soon.",
         .unit = "m",
         .min = 0,
         .max = 100});
  v.add("urgent_closure_rad", o.urgent_closure_rad,
        {.doc = "After a loop closure that differs more from the estimate the whole graph is optimised soon.",
         .unit = "rad",
         .min = 0,
         .max = 3.2});
}

void declareObjectFactors(BackendOptions& o, ParameterVisitor& v) {
  v.add("object_boxes", o.object_boxes, {.doc = "Whether the boxes of objects are factors of the graph."});
  v.add("object_sizes", o.object_sizes,
        {.doc = "Whether measured and usual sizes are factors of the graph; else a landmark keeps the mean "
                "size."});
  v.add(
      "object_views", o.object_views,
      {.doc = "Whether sightings of an object, or of one end of it, from one direction share an error; else all are "
               "independent."});
  v.add("object_sides", o.object_sides,
        {.doc = "Whether returns of scans on the sides of objects, and on the walls that doors are in, are "
                "factors of the graph."});
  v.add("points_inside", o.points_inside, {.doc = "Whether tracked points of an object are held inside it."});
  v.add("objects_on_floor", o.objects_on_floor, {.doc = "Whether objects are held to the floor."});
  v.add("side_sigma_m", o.side_sigma_m,
        {.doc = "Standard deviation of a side of an object, as a plane, against a return of a scan on it.",
         .unit = "m",
         .min = 1e-3,
         .max = 10});
  v.add("box_sigma", o.box_sigma,
        {.doc = "Standard deviation of a side of a detection's box against the projected landmark, as a "
                "share of the "
                "mean of the box's width and height; 2 px are added.",
         .min = 1e-3,
         .max = 10});
  v.add("points_per_landmark", o.points_per_landmark,
        {.doc = "Tracked points per landmark that are variables of the graph. 0: none.",
         .min = 0,
         .max = 10000});
  v.add("point_sigma_px", o.point_sigma_px,
        {.doc = "Standard deviation of the pixel of such a point.", .unit = "px", .min = 0.1, .max = 100});
  v.add("landmark_sigma_share", o.landmark_sigma_share,
        {.doc = "Standard deviation of a sighting in the graph, as a share of its proposal's, which also "
                "allows for "
                "the gross errors that the robust loss takes.",
         .min = 0.01,
         .max = 10});
  v.add("landmark_repeating_share", o.landmark_repeating_share,
        {.doc = "Share of a sighting's variance that all sightings of the object from one direction have in "
                "common; so "
                "with boxes, and with the points of one object.",
         .min = 0.01,
         .max = 0.99});
  v.add("landmark_view_rad", o.landmark_view_rad,
        {.doc =
             "Directions of view within this angle count as one view of a landmark, whose sightings share an "
             "error.",
         .unit = "rad",
         .min = 0.01,
         .max = 6.3});
}

}  // namespace

void BackendOptions::declareParameters(ParameterVisitor& v) {
  declareKeyPoses(*this, v);
  v.add("max_iterations", max_iterations,
        {.doc = "Iterations of one optimisation at most.", .min = 1, .max = 1000});
  v.add(
      "live_tolerance", live_tolerance,
      {.doc =
           "During the run an optimisation of the whole graph ends when the cost changes by a smaller share.",
       .min = 1e-12,
       .max = 0.1});
  v.add("final_tolerance", final_tolerance,
        {.doc = "At the end of the run an optimisation of the whole graph ends when the cost changes by a "
                "smaller share.",
         .min = 1e-12,
         .max = 0.1});
  v.add("closure_robust_width", closure_robust_width,
        {.doc = "Width of the Cauchy loss of loop closures, in standard deviations. 0: least squares.",
         .min = 0,
         .max = 100});
  v.add("landmark_robust_width", landmark_robust_width,
        {.doc = "Width of the Cauchy loss of object sightings, in standard deviations. 0: least squares.",
         .min = 0,
         .max = 100});
  v.add("planar_sigma_z_m", planar_sigma_z_m,
        {.doc = "Standard deviation of the height of a robot on the floor.",
         .unit = "m",
         .min = 1e-5,
         .max = 10});
  v.add("planar_sigma_tilt_rad", planar_sigma_tilt_rad,
        {.doc = "Standard deviation of roll and pitch of a robot on the floor.",
         .unit = "rad",
         .min = 1e-5,
         .max = 3});
  v.add("ground_sigma_rad", ground_sigma_rad,
        {.doc = "Standard deviation of the floor's normal as a handheld camera sees it.",
         .unit = "rad",
         .min = 1e-4,
         .max = 3});
  v.add("ground_sigma_m", ground_sigma_m,
        {.doc = "Standard deviation of the floor's distance as a handheld camera sees it.",
         .unit = "m",
         .min = 1e-4,
         .max = 10});
  v.add("pose_sigma_m", pose_sigma_m,
        {.doc = "Standard deviation of the current position within its surroundings, added to measurements "
                "when they "
                "are associated; drift since a landmark was last seen comes on top.",
         .unit = "m",
         .min = 0,
         .max = 10});
  declareObjectFactors(*this, v);
  v.add(
      "planar_graph", planar_graph,
      {.doc = "Whether graph.g2o is written in 2D (SE2) when the robot drives on a floor; that of a handheld "
              "camera is always in 3D."});
}

void ObjectLoopOptions::declareParameters(ParameterVisitor& v) {
  v.add("enabled", enabled, {.doc = "Whether constellations of objects propose loop closures."});
  v.add("recent_s", recent_s,
        {.doc = "Landmarks that were first seen within this time are compared with older ones.",
         .unit = "s",
         .min = 1,
         .max = 10000});
  v.add("every_nodes", every_nodes, {.doc = "Key poses between two searches.", .min = 1, .max = 100000});
  v.add("min_shift_m", min_shift_m,
        {.doc = "A smaller displacement is left to the association.", .unit = "m", .min = 0, .max = 100});
  v.add("min_pairs", constellation.min_pairs,
        {.doc = "Objects that two constellations must have in common.", .min = 3, .max = 100});
  v.add(
      "tolerance_m", constellation.tolerance_m,
      {.doc =
           "Two objects of two constellations correspond when they are within this distance after alignment.",
       .unit = "m",
       .min = 0.01,
       .max = 5});
  v.add("min_lead", constellation.min_lead,
        {.doc = "Corresponding objects that the best alignment must have more than the second best one.",
         .min = 0,
         .max = 100});
}

namespace {

void declareViews(RelocalisationOptions& o, ParameterVisitor& v) {
  v.add("views", o.views,
        {.doc = "Images that a map keeps at most, to be re-localised by; 0: none.", .min = 0, .max = 10000});
  v.add("view_corners", o.view_corners,
        {.doc = "Corners of an image that a map keeps at most, 38 bytes each.", .min = 20, .max = 5000});
  v.add("view_distance_m", o.view_distance_m,
        {.doc = "Images of a map are at least so far apart, or turned by view_angle_rad.",
         .unit = "m",
         .min = 0.05,
         .max = 100});
  v.add("view_angle_rad", o.view_angle_rad,
        {.doc = "See view_distance_m.", .unit = "rad", .min = 0.05, .max = 7});
}

void declareAgreement(RelocalisationOptions& o, ParameterVisitor& v) {
  v.add("tolerance_m", o.tolerance_m,
        {.doc = "Two sightings of the place in an earlier map agree within this distance.",
         .unit = "m",
         .min = 0.01,
         .max = 5});
  v.add(
      "tolerance_rad", o.tolerance_rad,
      {.doc = "Two sightings of the place agree within this angle.", .unit = "rad", .min = 0.005, .max = 1});
  v.add("recent_s", o.recent_s,
        {.doc = "Sightings older than this are forgotten.", .unit = "s", .min = 1, .max = 1000});
  v.add("agreeing", o.agreeing,
        {.doc = "Sightings that must agree, of at least two sources (objects, scans, images).",
         .min = 2,
         .max = 1000});
  v.add("agreeing_alone", o.agreeing_alone,
        {.doc = "Sightings that must agree when they are all of one source.", .min = 2, .max = 1000});
  v.add("alone_s", o.alone_s,
        {.doc = "Time that sightings of one source must span.", .unit = "s", .min = 0, .max = 1000});
  v.add("alone_m", o.alone_m,
        {.doc = "Way that sightings of one source must span; a radian turned counts as 0.5 m.",
         .unit = "m",
         .min = 0,
         .max = 1000});
  v.add("rival_share", o.rival_share,
        {.doc = "Sightings of other places, against those that agree, up to which these are believed.",
         .min = 0,
         .max = 1});
}

}  // namespace

void RelocalisationOptions::declareParameters(ParameterVisitor& v) {
  declareViews(*this, v);
  v.add("min_explained", min_explained,
        {.doc = "Share of the returns of the last scans that must lie on walls of the earlier map.",
         .min = 0,
         .max = 1});
  v.add("max_contradicted", max_contradicted,
        {.doc = "Largest share of these returns that may lie in its free space.", .min = 0, .max = 1});
  v.add("ambiguity_ratio", ambiguity_ratio,
        {.doc = "Scans tell no place when a second one reaches this share of the best score.",
         .min = 0,
         .max = 1});
  declareAgreement(*this, v);
  v.add("fix_distance_m", fix_distance_m,
        {.doc = "Way between two key poses that are tied to the earlier map.",
         .unit = "m",
         .min = 0.01,
         .max = 100});
}

}  // namespace roomgraph
