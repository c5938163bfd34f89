// SPDX-License-Identifier: BSD-3-Clause
// What is known about one detection: box, depth points, image edges, ground and class.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "roomgraph/geometry/box_sides.h"
#include "roomgraph/geometry/ground.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// A depth measurement inside a detection's box.
struct MaskPoint {
  double u = 0, v = 0;        ///< px
  Eigen::Vector3d in_ground;  ///< m, ground frame (geometry/ground.h)
};

/// Depth points that belong to a detected object (method.md sec. 1.3).
struct DepthMask {
  std::vector<MaskPoint> points;  ///< empty: no depth, or no cluster that can be the object
  double valid_ratio = 0;         ///< share of the box's (mask's) pixels that have a depth
  double goes_on = 0;             ///< share of what is beyond the box beside the points that continues them
};

/// Image edges in and around a box (method.md sec. 1.4).
struct BoxEdges {
  std::vector<Segment2> segments;  ///< straight parts (Hough), px of the whole image, longest first
  cv::Mat pixels;                  ///< CV_8UC1, Canny edges of the reduced image
  cv::Mat distance;  ///< CV_32FC1, px of the reduced image: to the nearest edge pixel; empty where depth is known
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< px; the reduced image's corner in the whole one
  double scale = 1;                                  ///< reduced px per px

  /// Distance to the nearest edge pixel, px. Outside the box: that of the nearest pixel in it, plus the distance to it.
  double distanceAt(const Eigen::Vector2d& pixel) const;
};

/// Directions of an object's vertical faces.
struct VerticalFaces {
  std::vector<double> azimuths;  ///< rad, ground frame: of the normals at depth points
  double most = 0;  ///< largest mean agreement of them with two directions at right angles
};

/// Everything a shape generator knows about one detection. The ground frame (geometry/ground.h) has its origin on
/// the floor below the camera, x along the optical axis' horizontal direction, y left, z up.
struct BoxEvidence {
  PinholeCamera camera;
  Plane ground;  ///< camera frame
  Pose3 camera_from_ground = Pose3::Identity();
  Box2 box;              ///< px, clipped to the image
  BoxSides cut;          ///< sides at the image border or at a nearer object: the object may reach beyond them
  BoxSides hidden;       ///< of these, the sides at a nearer object
  DepthMask mask;        ///< of the object; may be empty
  DepthMask all;         ///< everything in the box
  DepthMask around;      ///< of planar classes: beside and above the box, where the wall is
  DepthMask other_mask;  ///< the second best explanation of the box's points; may be empty
  BoxEdges edges;
  VerticalFaces faces;                 ///< of cuboids
  std::vector<Segment2> segments;      ///< of the edges, those the mask supports, longest first
  double ground_tilt_sigma = 0;        ///< rad, of the ground's normal; 0: measured, not corrected
  const ObjectModel* model = nullptr;  ///< class of the object; never null when a generator is called
};

/// Farther away a pixel of the box's bottom side is metres on the ground: it places nothing.
inline constexpr double kFarthestGround_m = 20;
/// A box of a smaller half angle is too narrow to tell a range.
inline constexpr double kLeastHalfAngle_rad = 1e-3;

/// Where the middle of the box's bottom side meets the ground (paper Eq. 2), ground frame; nothing when that side is
/// cut or above the horizon.
std::optional<Eigen::Vector2d> contactPoint(const BoxEvidence& evidence);
/// Direction of the box's middle on the ground, rad, ground frame.
double bearingOf(const BoxEvidence& evidence);
/// Half of the angle on the ground between the box's left and right side, rad.
double halfAngleOf(const BoxEvidence& evidence);

}  // namespace roomgraph
