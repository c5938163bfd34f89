// SPDX-License-Identifier: BSD-3-Clause
// What a recording shows of the calibration of its sensors: paths, walls in scans, planes in depth images.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "planar_path.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Straight piece of wall in a scan: normal . p = distance for p in the lidar's horizontal frame, the normal
/// towards the lidar.
struct ScanWall {
  Eigen::Vector2d normal, along;         ///< unit vectors; along: normal turned by +90 deg
  double distance_m = 0;                 ///< not positive
  double from_m = 0, to_m = 0;           ///< extent, as along . p
  double middle_m = 0;                   ///< mean of along . p of the returns
  double sigma_m = 0, spread_m = 0;      ///< of the distance at the middle; standard deviation of along . p
  double sigmaAt(double along_m) const;  ///< of the distance there
};

struct WallScan {
  double t = 0;  ///< s
  std::vector<ScanWall> walls;
};

/// Means over depth pixels of one surface. Of the same pixels, depths scale * z + bias have their mean at
/// scale * point + bias * ray, which lies on the surface when it is a plane.
struct DepthPatch {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m, optical frame
  Eigen::Vector3d ray = Eigen::Vector3d::Zero();    ///< with z = 1
};

/// A small block of a depth image.
struct DepthCell {
  DepthPatch patch;
  Eigen::Vector3d normal;  ///< of the surface, towards the camera; optical frame
};

/// Planes in one depth image.
struct DepthView {
  double t = 0;  ///< s
  std::vector<DepthPatch> floor;
  std::vector<DepthCell> upright;  ///< surfaces that stand upright, about as high as the lidar
};

/// Movement of the camera between two images by visual odometry.
struct CameraStep {
  double t_a = 0, t_b = 0;             ///< s
  Pose3 a_from_b = Pose3::Identity();  ///< optical frames, in units of the recorded depth
  double depth_m = 1;                  ///< of what was seen, median
};

/// A chessboard in one image.
struct BoardView {
  double t = 0;                                 ///< s
  Pose3 camera_from_board = Pose3::Identity();  ///< optical frame; origin in the board's middle, z normal to it
  Eigen::Matrix3d turn_covariance = Eigen::Matrix3d::Zero();   ///< rad^2, nominal; small turns in the board's frame
  Eigen::Matrix3d place_covariance = Eigen::Matrix3d::Zero();  ///< m^2, nominal; of its middle, in the optical frame
  std::optional<DepthPatch> depth;              ///< measured on it
};

/// The evidence of one recording. Paths: an unbroken stretch each. Those of the lidar are of its horizontal
/// frame (its planar pose on the robot, as recorded) in the scan matcher's.
struct RecordingEvidence {
  std::vector<PlanarPath> lidar, wheels;
  std::vector<WallScan> scans;
  std::vector<DepthView> views;
  std::vector<CameraStep> steps;
  std::vector<BoardView> boards;  ///< of one that stands still
};

}  // namespace roomgraph
