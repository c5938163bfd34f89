// SPDX-License-Identifier: BSD-3-Clause
// MRPT class registration of the GroundDetector interface; prediction where the floor is not seen.
#include "roomgraph/proposals/ground_detector.h"

namespace roomgraph {

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(GroundDetector, Stage, roomgraph)

namespace {

constexpr double kPredictedVariance = 1e-4;  // rad², m²: half a degree and 1 cm, as a robot pitches on its wheels

}  // namespace

FrameGround groundOf(const Frame& frame, const std::optional<Plane>& expected, GroundDetector& detector) {
  FrameGround out;
  if (!frame.camera.valid()) {
    out.reason = "no camera intrinsics";
    return out;
  }
  if (const auto seen = detector.detect(frame, expected)) {
    out.estimate = *seen;
  } else {
    out.reason = seen.reason();
    if (expected) out.estimate = GroundEstimate{*expected, Eigen::Matrix4d::Identity() * kPredictedVariance, false};
  }
  return out;
}

}  // namespace roomgraph
