// SPDX-License-Identifier: BSD-3-Clause
// Circular drive with drifting motion sources and exact closures.
#pragma once

#include "random_poses.h"
#include "roomgraph/estimation/motion.h"

namespace roomgraph::test {

inline constexpr int kNodes = 40;

// As shipped for wheels and for scans.
inline constexpr MotionNoise kWheelNoise{0.01, 0.10, 0.01, 0.15, 0.10},
    kScanNoise{0.001, 0.01, 0.0005, 0.01, 0.003, 0.01, 0.003};

// Once round a circle of 1.5 m radius in kNodes seconds.
inline Pose3 truthAt(double t) {
  const double angle = 2 * M_PI * t / kNodes;
  return poseFromYpr(1.5 * std::sin(angle), 1.5 * (1 - std::cos(angle)), 0, angle, 0, 0);
}

// A source whose every step of `seconds` is too long by a factor and turned too far by a share.
inline MotionSource drifting(double scale, double turn, const MotionNoise& noise, double seconds = 0.5) {
  MotionSource source(noise, true);
  Pose3 pose = Pose3::Identity();
  for (double t = 0; t <= kNodes; t += seconds) {
    source.add(t, pose, 0, Matrix6d::Zero());
    Pose2 step = planarPart(truthAt(t).inverse() * truthAt(t + seconds));
    pose = pose * toPose3(Pose2{scale * step.x, scale * step.y, turn * step.yaw});
  }
  return source;
}

inline RelativePose closure(double t_a, double t_b) {
  RelativePose out{t_a,  t_b,   truthAt(t_a).inverse() * truthAt(t_b), 1e-4 * Matrix6d::Identity(),
                   true, "test"};
  return out;
}

}  // namespace roomgraph::test
