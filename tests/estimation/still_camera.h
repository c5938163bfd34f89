// SPDX-License-Identifier: BSD-3-Clause
// A camera 1 m above the floor that looks along x, in a robot without sources of motion.
#pragma once

#include "roomgraph/estimation/drift.h"
#include "roomgraph/estimation/motion.h"
#include "roomgraph/observations/frame.h"

namespace roomgraph::test {

inline const Motion& standing() {
  static const MotionNoise noise;
  static const Motion motion{MotionSource(noise, true), MotionSource(noise, false),
                             MotionSource(noise, true)};
  return motion;
}

inline const Drift& noDrift() {
  static const Drift drift(standing(), false);
  return drift;
}

inline Frame frameAt(int i, double t) {
  Frame frame;
  frame.id = FrameId{i};
  frame.t = t;
  frame.camera = {320, 240, 260, 260, 159.5, 119.5, {}};
  frame.robot_from_camera = poseFromYpr(0, 0, 1, 0, 0, 0);
  frame.robot_from_camera.linear() = bodyFromOptical();
  return frame;
}

/// The depth of every pixel; 0: none.
inline Frame frameOfDepth(int i, double t, float depth_m) {
  Frame frame = frameAt(i, t);
  frame.depth = cv::Mat(frame.camera.height, frame.camera.width, CV_32FC1, cv::Scalar(depth_m));
  return frame;
}

}  // namespace roomgraph::test
