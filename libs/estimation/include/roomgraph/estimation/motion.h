// SPDX-License-Identifier: BSD-3-Clause
// Motion sources with their trajectories and noise models.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "roomgraph/estimation/options.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// Movement of the robot measured by one source.
struct Movement {
  Pose3 a_from_b = Pose3::Identity();
  Matrix6d covariance = Matrix6d::Identity();
};

/// A movement that no source covers: bounded only by the speed of a walk or a drive.
Movement unknownMovement(double seconds);

/// One source of motion: its trajectory in its own frame, and its noise model.
class MotionSource {
 public:
  MotionSource(MotionNoise noise, bool planar) : noise_(noise), planar_(planar) {}

  /// Ignores a pose whose stamp does not come after the last one; returns whether it was added.
  /// `step_covariance`: of the movement since the last pose, on top of the noise model.
  bool add(double t, const Pose3& odom_from_robot, int segment, const Matrix6d& step_covariance);
  /// The same for a source, of all its poses, of whose steps nothing but the noise model is known. After a pause of more than two seconds
  /// in which it did not move, the robot may have been carried: what the source says of it counts as unknownMovement().
  bool add(double t, const Pose3& odom_from_robot, int segment);
  /// Replaces the poses (later data refined them); the step covariances stay.
  void refine(const Trajectory& poses) { poses_ = poses; }

  const Trajectory& poses() const { return poses_; }
  /// Covariance: noise model, sum of the steps, and more for a time after the last pose.
  std::optional<Movement> between(double t_a, double t_b, double horizon_s) const;
  /// Whether a pause lies in it in which the robot may have been carried.
  bool pausedWithin(double t_a, double t_b) const;
  /// As seen in a local map that begins at `t_a`: the covariance is that of the match at `t_b`, and does not
  /// grow with the movement. A segment's first pose is matched to nothing: it has the noise model's alone.
  std::optional<Movement> inLocalMap(double t_a, double t_b, double horizon_s) const;
  /// Between the beginnings of two local maps: what adds up of `between`.
  std::optional<Movement> betweenLocalMaps(double t_a, double t_b, double horizon_s) const;
  /// What of the covariance of single movements adds up from one local map to the next (MotionNoise::drift_share).
  Matrix6d addsUp(const Matrix6d& covariance) const;

 private:
  bool append(double t, const Pose3& odom_from_robot, int segment);
  Matrix6d stepSum(double t_a, double t_b) const;
  Matrix6d pausesWithin(double t_a, double t_b) const;
  Matrix6d stepAt(double t) const;
  /// How unsure a pose is within a time in which nothing was seen.
  Matrix6d interpolation(double t) const;
  /// The same, or what a pose after the last one is more unsure than that.
  Matrix6d extrapolation(double t) const;

  MotionNoise noise_;
  bool planar_;
  Trajectory poses_;
  GrowingList<std::pair<double, Matrix6d>> summed_;  // by time
  std::vector<std::pair<double, double>> pauses_;    // from, until
  std::set<int> begun_;                              // segments
  std::set<double> beginnings_;                      // of segments, s
};

/// What is known of every pose of a robot that drives on a floor: z, roll and pitch are 0, with these standard deviations.
struct OnFloor {
  double sigma_z_m = 0, sigma_tilt_rad = 0;
};

/// All sources of one run.
struct Motion {
  MotionSource odometry, visual, lidar;
  std::optional<OnFloor> floor = std::nullopt;  ///< none: handheld, or not known yet

  /// Movement between two times by all sources that cover them, each with the weight of its covariance (less where it contradicts the
  /// first of scans, images, wheels that stays on the floor by several standard deviations, much less where it leaves the floor); nothing
  /// when none covers them.
  std::optional<Pose3> movement(double t_a, double t_b, double horizon_s) const;
};

}  // namespace roomgraph
