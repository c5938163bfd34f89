// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the search for the ground plane, and the two shipped ground detectors.
#include "depth_ground_detector.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(DepthGroundDetector, GroundDetector, roomgraph)
IMPLEMENTS_MRPT_OBJECT(ExpectedGroundDetector, GroundDetector, roomgraph)

void DepthGroundDetector::declareParameters(ParameterVisitor& v) {
  v.add("max_angle_error_rad", search_.max_angle_error_rad,
        {.doc = "Largest angle between the measured and the expected ground normal.",
         .unit = "rad",
         .min = 0,
         .max = 1.5});
  v.add("max_height_error_m", search_.max_height_error_m,
        {.doc = "Largest difference between the measured and the expected height of the camera.",
         .unit = "m",
         .min = 0,
         .max = 2});
  v.add(
      "max_tilt_rad", search_.max_tilt_rad,
      {.doc =
           "Without an expected ground: largest angle between the ground normal and the upward direction of "
           "the image.",
       .unit = "rad",
       .min = 0,
       .max = 1.5});
  v.add("min_camera_height_m", search_.min_camera_height_m,
        {.doc = "Without an expected ground: a plane nearer to the camera than this is no floor.",
         .unit = "m",
         .min = 0,
         .max = 5});
  v.add("max_range_m", search_.max_range_m,
        {.doc = "Farther depth is not used for the ground.", .unit = "m", .min = 0.5, .max = 20});
}

Outcome<GroundEstimate> DepthGroundDetector::detect(const Frame& frame, const std::optional<Plane>& expected) {
  return findGround(frame, expected, search_);
}

Outcome<GroundEstimate> ExpectedGroundDetector::detect(const Frame&, const std::optional<Plane>&) {
  return Outcome<GroundEstimate>::failure("the depth image is not searched for it");
}

}  // namespace roomgraph
