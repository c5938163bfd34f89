// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <Eigen/Core>

#include "roomgraph/core/ids.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

// The measurements that make up the graph (method.md sec. 4). World is the frame of all estimates; `node`
// poses are world_from_robot. Covariances are in the order (translation, rotation) and in the measurement's
// own frame.

/// Movement between two poses: odometry, visual odometry, scan match, loop closure.
struct BetweenFactor {
  NodeId a, b;
  Pose3 a_from_b = Pose3::Identity();
  Matrix6d covariance = Matrix6d::Identity();
  double robust_width = 0;  ///< Cauchy loss width in standard deviations; 0: plain least squares
};

/// Planar motion of a robot on the floor: z, roll and pitch of a pose are near 0.
struct PlanarFactor {
  NodeId node;
  double sigma_z_m = 0.01, sigma_tilt_rad = 0.01;
};

/// Ground plane seen from a pose (normal . x + offset = 0 in the robot frame, normal up) against z = 0 in
/// world.
struct GroundFactor {
  NodeId node;
  Eigen::Vector3d normal_in_robot = Eigen::Vector3d::UnitZ();
  double offset_m = 0;  ///< height of the robot frame's origin above the plane
  double sigma_normal_rad = 0.02, sigma_offset_m = 0.02;
};

/// Bottom centre of an object, and its yaw when observable, seen from a pose.
struct LandmarkFactor {
  NodeId node;
  LandmarkId landmark;
  Eigen::Vector3d position_in_robot = Eigen::Vector3d::Zero();
  double yaw_in_robot = 0;
  bool has_yaw = false;
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();  ///< of (x, y, z, yaw) in the robot frame
  double weight = 1;        ///< association probability x initialisation score, scales the (robust) cost
  double robust_width = 1;  ///< Cauchy loss width in standard deviations; 0: plain least squares
};

/// The object stands on the floor: z = 0.
struct LandmarkGroundFactor {
  LandmarkId landmark;
  double sigma_z_m = 0.02;
};

}  // namespace roomgraph
