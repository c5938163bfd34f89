// SPDX-License-Identifier: BSD-3-Clause
// Sensors of a random flat within the ranges of small robots' hardware.
#include "flat_draft.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

CameraSpec drawCamera(bool robot, Random& random) {
  CameraSpec out;
  out.rate_hz = pick<double>(random, {6, 8, 10});
  out.model.fx = out.model.fy = inSteps(random.uniform(515, 545), 0.1);
  out.noise_gain = inSteps(random.uniform(0.7, 1.5));
  out.far_m = inSteps(random.uniform(4, 6), 0.1);
  out.near_m = inSteps(random.uniform(0.4, 0.6));
  out.jpeg_quality = drawInt(random, 75, 92);
  if (!robot) return out;
  const double height = inSteps(random.uniform(0.3, 1.3));
  out.at_m = {inSteps(random.uniform(-0.05, 0.12)), inSteps(random.uniform(-0.03, 0.03)), height};
  // The higher, the more it looks down; a low one looks ahead.
  const double steepest = 4 + 21 * (height - 0.3);
  out.pitch_down_rad = kDegree * inSteps(random.uniform(0.35 * (steepest - 4), steepest), 0.1);
  return out;
}

LidarSpec drawLidar(Random& random) {
  LidarSpec out;
  out.rate_hz = inSteps(random.uniform(5.5, 10), 0.1);
  out.beams = 90 * drawInt(random, 4, 8);
  out.at_m = {inSteps(random.uniform(-0.08, 0.1)), 0, inSteps(random.uniform(0.1, 0.4))};
  out.min_m = inSteps(random.uniform(0.12, 0.2));
  out.max_m = inSteps(random.uniform(6, 12), 0.1);
  out.sigma_m = inSteps(random.uniform(0.004, 0.018), 0.001);
  out.sigma_relative = inSteps(random.uniform(0.002, 0.012), 0.001);
  out.dropouts = inSteps(random.uniform(0, 0.03), 0.001);
  return out;
}

OdometrySpec drawOdometry(Random& random) {
  OdometrySpec out;
  out.scale_error = inSteps(random.uniform(-0.04, 0.04), 0.001);
  out.turn_error = inSteps(random.uniform(-0.04, 0.04), 0.001);
  out.drift_rad_m = kDegree * inSteps(random.uniform(-0.7, 0.7), 0.01);
  out.sigma_length = inSteps(random.uniform(0.01, 0.04), 0.001);
  out.sigma_turn = inSteps(random.uniform(0.01, 0.05), 0.001);
  out.slips = drawInt(random, 0, 4);
  out.slip_m = inSteps(random.uniform(0.03, 0.2));
  out.slip_rad = kDegree * inSteps(random.uniform(1, 8), 0.1);
  return out;
}

DetectionsSpec drawDetections(Random& random) {
  DetectionsSpec out;
  out.persistent = true;
  out.detect_probability = inSteps(random.uniform(0.8, 0.96));
  out.min_visible = inSteps(random.uniform(0.15, 0.35));
  out.min_height_px = drawInt(random, 18, 34);
  out.jitter = inSteps(random.uniform(0.012, 0.04), 0.001);
  out.false_positives = inSteps(random.uniform(0.01, 0.1));
  out.mislead = inSteps(random.uniform(0.5, 1.3));
  out.duplicates = inSteps(random.uniform(0.005, 0.06), 0.001);
  out.memory_s = inSteps(random.uniform(0.4, 1.5), 0.1);
  return out;
}

}  // namespace

void drawSensors(FlatDraft& draft, Random& random) {
  World& world = draft.world;
  world.camera = drawCamera(world.robot.has_value(), random);
  if (world.robot) {
    world.lidar = drawLidar(random);
    world.odometry = drawOdometry(random);
  }
  world.detections = drawDetections(random);
}

}  // namespace roomgraph
