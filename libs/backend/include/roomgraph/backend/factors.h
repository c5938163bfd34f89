// SPDX-License-Identifier: BSD-3-Clause
// Factor types of the graph: odometry, ground, landmark, box, size and point measurements, marginal prior.
#pragma once

#include <Eigen/Core>
#include <variant>
#include <vector>

#include "roomgraph/core/ids.h"
#include "roomgraph/geometry/box.h"
#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/pose.h"
#include "roomgraph/geometry/shape.h"

namespace roomgraph {

// The measurements that make up the graph (method.md sec. 4). World is the frame of all estimates; `node`
// poses are world_from_robot. Covariances are in the order (translation, rotation) and in the measurement's
// own frame.

using PointId = Id<struct PointTag>;  ///< one feature point of the map

/// Estimate of a landmark in world.
struct LandmarkEstimate {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< bottom centre
  double yaw = 0;
  ObjectShape shape = {};  ///< kind and size; the kind never changes, the size only with a LandmarkSizeFactor
};

/// Movement between two poses: odometry, visual odometry, scan match, loop closure.
struct BetweenFactor {
  NodeId a, b;
  Pose3 a_from_b = Pose3::Identity();
  Matrix6d covariance = Matrix6d::Identity();
  double robust_width = 0;  ///< Cauchy loss width in standard deviations; 0: plain least squares
};

/// Planar motion of a robot on the floor: z, roll and pitch of a pose are near 0; or z of another place in its frame, and the
/// tilt of another axis.
struct PlanarFactor {
  NodeId node;
  double sigma_z_m = 0.01, sigma_tilt_rad = 0.01;
  Eigen::Vector3d place_in_robot = Eigen::Vector3d::Zero(), up_in_robot = Eigen::Vector3d::UnitZ();
};

/// Ground plane seen from a pose (normal . x + offset = 0 in the robot frame, normal up) against z = 0 in
/// world.
struct GroundFactor {
  NodeId node;
  Eigen::Vector3d normal_in_robot = Eigen::Vector3d::UnitZ();
  double offset_m = 0;  ///< height of the robot frame's origin, or of `place_in_robot`, above the plane
  double sigma_normal_rad = 0.02, sigma_offset_m = 0.02;
  Eigen::Vector3d place_in_robot = Eigen::Vector3d::Zero();
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
  Eigen::Vector3d ahead_in_robot = Eigen::Vector3d::UnitX();  ///< the direction, seen from above, that the yaw is counted from
};

/// A landmark as it, or one end of it, seems from one direction against the landmark itself: the error that all sightings from
/// there share has mean zero and this covariance. From there the landmark seems to stand beside its place
/// when its size was taken for another one: by offset + offset_by_size * (width, depth, height), x forward
/// and y left in the landmark's frame.
struct LandmarkViewFactor {
  LandmarkId view, landmark;
  Eigen::Vector2d offset_m = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, 2, 3> offset_by_size = Eigen::Matrix<double, 2, 3>::Zero();
  bool has_yaw = false;
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();  ///< of (x, y, z, yaw) in world
  double weight = 1;        ///< association probability x initialisation score, scales the (robust) cost
  double robust_width = 1;  ///< Cauchy loss width in standard deviations; 0: plain least squares
};

/// The object rests on the floor: z = 0.
struct LandmarkGroundFactor {
  LandmarkId landmark;
  double sigma_z_m = 0.02;
};

/// A landmark's size, measured or by the object database (factor 6). Makes the landmark's size variable.
struct LandmarkSizeFactor {
  LandmarkId landmark;
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();  ///< width, depth, height
  Eigen::Vector3d sigma_m = Eigen::Vector3d::Constant(0.1);
  bool at_least = false;  ///< it may be larger
};

/// Bounding box of a landmark in an image against that of its projected model (factor 3, paper Eq. 12). A
/// side of the measured box on the image border is not compared: the object may extend beyond it.
/// The landmark must have a size.
struct LandmarkBoxFactor {
  NodeId node;
  LandmarkId landmark;
  PinholeCamera camera;
  Pose3 robot_from_camera = Pose3::Identity();  ///< optical frame
  Box2 box;                                     ///< measured, px
  double sigma_px = 4;                          ///< of each side
  double weight = 1;        ///< association probability x initialisation score, scales the (robust) cost
  double robust_width = 1;  ///< Cauchy loss width in standard deviations; 0: plain least squares
};

enum class RobustLoss { kHuber, kCauchy };

/// A point seen in an image, with its depth when measured (factor 2, paper Eq. 11).
struct CameraPointFactor {
  NodeId node;
  PointId point;
  PinholeCamera camera;
  Pose3 robot_from_camera = Pose3::Identity();  ///< optical frame
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 1;
  double depth_m = 0;  ///< along the optical axis; 0: not measured
  double sigma_depth_m = 0.02;
  RobustLoss loss = RobustLoss::kHuber;
  double robust_width = 2.5;  ///< in standard deviations; 0: plain least squares
};

/// A point of a landmark lies inside its model (factor 4, paper Eq. 14): horizontal and vertical distance
/// from the volume, 0 inside.
struct PointLandmarkFactor {
  PointId point;
  LandmarkId landmark;
  double sigma_horizontal_m = 0.05, sigma_vertical_m = 0.05;
  double weight = 1;        ///< association probability x initialisation score, scales the (robust) cost
  double robust_width = 1;  ///< Cauchy loss width in standard deviations; 0: plain least squares
};

/// A return of a lidar that ends on an upright side of a landmark: it lies on that side's plane. Of a
/// cylinder, whose legs stand anywhere in it: it lies inside. The landmark must have a size.
struct LandmarkSideFactor {
  NodeId node;
  LandmarkId landmark;
  Eigen::Vector3d point_in_robot = Eigen::Vector3d::Zero();
  Eigen::Vector2d outward =
      Eigen::Vector2d::UnitX();  ///< normal of the side in the landmark's frame: +-x or +-y
  double sigma_m = 0.05;
  double weight = 1;        ///< scales the (robust) cost
  double robust_width = 1;  ///< Cauchy loss width in standard deviations; 0: plain least squares
};

/// Some variables of a graph.
struct Variables {
  std::vector<NodeId> nodes;
  std::vector<LandmarkId> landmarks;
  std::vector<PointId> points;
};

/// Prior on variables from the measurements of a marginalised part: cost 1/2 |root d + offset|^2 with d the
/// difference from the point of linearisation. Per pose 6 numbers (translation in world, rotation vector w
/// with R = exp(w) R_linearised), per landmark 7 (x, y, z, yaw, width, depth, height), per point 3, in the
/// order of `variables`: poses, landmarks, points. Made by FactorGraph::marginalize.
struct MarginalPrior {
  Variables variables;
  std::vector<Pose3> poses;                 ///< point of linearisation, like the following
  std::vector<LandmarkEstimate> landmarks;  ///< shape kinds are not used
  std::vector<Eigen::Vector3d> points;
  Eigen::MatrixXd root;
  Eigen::VectorXd offset;
};

/// Every kind of measurement in a graph. A new kind is added here; the tests do not compile until it has
/// specimens (tests/backend/residual_specimens.h).
using Factor = std::variant<BetweenFactor, PlanarFactor, GroundFactor, LandmarkFactor, LandmarkViewFactor,
                            LandmarkGroundFactor, LandmarkSizeFactor, LandmarkBoxFactor, CameraPointFactor,
                            PointLandmarkFactor, LandmarkSideFactor, MarginalPrior>;

}  // namespace roomgraph
