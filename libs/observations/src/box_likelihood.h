// SPDX-License-Identifier: BSD-3-Clause
// Likelihood of the boxes of one image given the landmarks of a map and the camera's pose.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "roomgraph/geometry/box.h"
#include "roomgraph/geometry/camera.h"
#include "roomgraph/observations/landmark.h"
#include "roomgraph/observations/map_options.h"

namespace roomgraph {

/// A detection reduced to what its likelihood depends on.
struct ClassBox {
  Box2 box;  ///< px, inside the image
  std::string class_name;
};

/// What is to be seen of a landmark (method.md sec. 6.1).
struct ExpectedBox {
  const Landmark* landmark = nullptr;  ///< that of the map
  Box2 bounds;                         ///< not cut by the image border, px
  Eigen::Array4d sigma;                ///< of u_min, v_min, u_max, v_max, px
  double count = 0;                    ///< mean number of boxes, r_j
};

/// Landmarks in the image of a camera, without those too far, too near or outside.
std::vector<ExpectedBox> expectedBoxes(const std::vector<Landmark>& landmarks,
                                       const mrpt::maps::COccupancyGridMap2D* grid,
                                       const Pose3& world_from_camera, const PinholeCamera& camera,
                                       const MapLikelihoodOptions& options);

/// Whether no occupied cell lies between two points of the ground, but for the last `reach_m` before `to`.
bool clearView(const mrpt::maps::COccupancyGridMap2D& grid, const Eigen::Vector2d& from,
               const Eigen::Vector2d& to, double reach_m);

/// Density g(b | l) of a box's place, 1 / px^n for n sides off the image border.
double boxDensityOf(const Box2& box, const ExpectedBox& expected, const PinholeCamera& camera,
                    double hidden_side);

/// The same of a box that may be anywhere.
double clutterDensity(const Box2& box, const PinholeCamera& camera);

/// log p(Z | x), untempered; `labels` is the number of classes that a box may have.
double logLikelihoodOf(const std::vector<ClassBox>& boxes, const std::vector<ExpectedBox>& expected,
                       const PinholeCamera& camera, int labels, const MapLikelihoodOptions& options);

}  // namespace roomgraph
