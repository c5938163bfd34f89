// SPDX-License-Identifier: BSD-3-Clause
// Declaration of the options of the semantic map as a metric map.
#include "roomgraph/observations/map_options.h"

#include <cmath>
#include <numbers>

namespace roomgraph {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;

void declareCamera(MapLikelihoodOptions& options, ParameterVisitor& v) {
  v.add("camera_width", options.camera_width,
        {.doc = "Width of the camera's image; 0: no likelihood of boxes.", .unit = "px", .min = 0});
  v.add("camera_height", options.camera_height,
        {.doc = "Height of the camera's image.", .unit = "px", .min = 0});
  v.add("camera_fx", options.camera_fx, {.doc = "Focal length.", .unit = "px", .min = 0});
  v.add("camera_fy", options.camera_fy, {.doc = "Focal length.", .unit = "px", .min = 0});
  v.add("camera_cx", options.camera_cx, {.doc = "Principal point.", .unit = "px"});
  v.add("camera_cy", options.camera_cy, {.doc = "Principal point.", .unit = "px"});
  v.add("camera_x", options.camera_x, {.doc = "Place of the camera on the robot.", .unit = "m"});
  v.add("camera_y", options.camera_y, {.doc = "Place of the camera on the robot.", .unit = "m"});
  v.add("camera_z", options.camera_z, {.doc = "Place of the camera on the robot.", .unit = "m"});
  v.add("camera_yaw_deg", options.camera_yaw_deg, {.doc = "Direction of the camera.", .unit = "deg"});
  v.add("camera_pitch_deg", options.camera_pitch_deg,
        {.doc = "Direction of the camera; positive: down.", .unit = "deg"});
  v.add("camera_roll_deg", options.camera_roll_deg, {.doc = "Direction of the camera.", .unit = "deg"});
}

}  // namespace

void MapLikelihoodOptions::declareParameters(ParameterVisitor& v) {
  v.add("use_grid", use_grid, {.doc = "Likelihood of scans, by the occupancy grid."});
  v.add("use_objects", use_objects, {.doc = "Likelihood of detections, by the landmarks."});
  declareCamera(*this, v);
  v.add("detection_probability", detection_probability,
        {.doc = "Mean number of boxes of an object that exists and is in full view.", .min = 0, .max = 1});
  v.add("clutter_boxes", clutter_boxes,
        {.doc = "Mean number of boxes in an image that show no landmark.", .min = 1e-6, .max = 100});
  v.add("box_sigma", box_sigma,
        {.doc = "Standard deviation of a side, as a share of the projected object's size.",
         .min = 0,
         .max = 10});
  v.add("side_sigma_px", side_sigma_px,
        {.doc = "Standard deviation of a side that is added.", .unit = "px", .min = 0.1});
  v.add("hidden_side", hidden_side,
        {.doc = "Probability that a side of a box is anywhere: hidden, or of something else.",
         .min = 0,
         .max = 1});
  v.add("wrong_label", wrong_label,
        {.doc = "Probability that a label is one at random.", .min = 0, .max = 1});
  v.add("behind_walls", behind_walls,
        {.doc = "Share of the detection probability that is left to objects behind occupied cells.",
         .min = 0,
         .max = 1});
  v.add("near_m", near_m, {.doc = "Nearer objects are not detected.", .unit = "m", .min = 0});
  v.add("far_m", far_m, {.doc = "Farther objects are not detected.", .unit = "m", .min = 0});
  v.add(
      "tempering", tempering,
      {.doc = "Exponent of the likelihood: errors of boxes repeat from image to image.", .min = 0, .max = 1});
}

PinholeCamera MapLikelihoodOptions::cameraOf(int width, int height) const {
  const PinholeCamera camera{camera_width, camera_height, camera_fx, camera_fy, camera_cx, camera_cy, {}};
  if (!camera.valid() || width <= 0 ||
      std::int64_t{width} * camera_height != std::int64_t{height} * camera_width)
    return {};
  return width == camera_width ? camera : camera.scaled(static_cast<double>(width) / camera_width);
}

Pose3 MapLikelihoodOptions::robotFromCamera() const {
  Pose3 pose = poseFromYpr(camera_x, camera_y, camera_z, camera_yaw_deg * kRadPerDeg,
                           camera_pitch_deg * kRadPerDeg, camera_roll_deg * kRadPerDeg);
  pose.linear() = pose.linear() * bodyFromOptical();
  return pose;
}

void MapInsertionOptions::declareParameters(ParameterVisitor& v) {
  v.add(
      "grid_resolution_m", grid_resolution_m,
      {.doc = "Size of a cell of the grid that the first scan makes.", .unit = "m", .min = 0.005, .max = 1});
  v.add("insert_objects", insert_objects, {.doc = "Whether detections make and correct landmarks."});
  v.add("new_object_score", new_object_score,
        {.doc = "Boxes of a lower score make no new landmark.", .min = 0, .max = 1});
  v.add(
      "gate_sigma", gate_sigma,
      {.doc = "A detection farther from all landmarks of its class is of a new one, in standard deviations.",
       .min = 0.1});
}

}  // namespace roomgraph
