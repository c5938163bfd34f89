// SPDX-License-Identifier: BSD-3-Clause
// Drift: how uncertain the latest key pose is relative to the earlier ones.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/estimation/motion.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// Uncertainty of the latest key pose relative to every earlier one: the least that a chain of movements and
/// loop closures between the two gives (Dijkstra projection, Bosse et al., "Simultaneous localization and map
/// building in large-scale cyclic environments using the Atlas framework", IJRR 2004, sec. 3.3). It is kept
/// up to date in O(key poses) per key pose and closure.
class Drift {
 public:
  /// `local_maps`: images and scans are matched to such, and of the variances of their movements only
  /// MotionNoise::drift_share adds up. `motion` outlives this.
  Drift(const Motion& motion, bool local_maps) : motion_(motion), local_maps_(local_maps) {}

  /// Takes in the key poses that are new since the last call.
  void extend(const KeyPoses& poses);
  /// The movement up to the latest key pose over a time that no source covers.
  void link(const KeyPoses& poses, const RelativePose& movement);
  /// A loop closure between two times up to the latest key pose.
  void close(const KeyPoses& poses, const RelativePose& closure);
  /// Whether a loop closure that ends at about the latest key pose is out of the question: farther from the estimate than
  /// the drift since its beginning may have led, by several standard deviations. Places look alike.
  bool contradicts(const KeyPoses& poses, const RelativePose& closure) const;
  /// Whether the estimate tells such a closure from its rival: it is nearer to it, by two standard deviations of the drift.
  bool tellsFromRival(const KeyPoses& poses, const RelativePose& closure) const;
  /// Variance (m^2, along the direction in which it is largest) of where a place (world, m) that was last seen at time t is from
  /// the latest key pose.
  double variance(const KeyPoses& poses, double t, const Eigen::Vector2d& place) const;
  /// Variance (rad^2) of the latest key pose's yaw relative to that at time t.
  double turned(const KeyPoses& poses, double t) const;

 private:
  /// Sums over steps, each of which turns what follows about the place where it ends.
  struct Spread {
    double position_m2 = 0, yaw_rad2 = 0;
    Eigen::Vector2d lever_rad2m = Eigen::Vector2d::Zero();    ///< of variances of turns times their pivots (world)
    Eigen::Matrix2d lever2_rad2m2 = Eigen::Matrix2d::Zero();  ///< the same with the pivots' squares (outer products)

    static Spread of(double position_m2, double yaw_rad2, const Eigen::Vector2d& pivot);
    Spread& operator+=(const Spread& other);
    Spread& operator-=(const Spread& other);
    /// Variance (m^2) of a place along the direction in which it is largest: turns move it by its distance from their pivots.
    double about(const Eigen::Vector2d& place) const;
    void takeYaw(const Spread& other);
  };
  Spread ofStep(const KeyPose& a, const KeyPose& b) const;
  Spread walked(std::size_t from, std::size_t to) const;
  /// Of the distance of a closure, which ends at about the latest key pose, from the estimate.
  double varianceOf(const KeyPoses& poses, const RelativePose& closure) const;

  const Motion& motion_;
  bool local_maps_;
  std::vector<Spread> walked_;  ///< from the first key pose
  std::vector<Spread> since_;   ///< of the latest key pose relative to each
};

}  // namespace roomgraph
