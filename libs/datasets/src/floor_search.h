// SPDX-License-Identifier: BSD-3-Clause
// Detection of the floor plane in a coarse grid of depth points.
#pragma once

#include <optional>

#include "point_grid.h"
#include "roomgraph/geometry/ground.h"

namespace roomgraph {

/// The floor in a grid: the largest plane that faces within 30 degrees of `up` and has (nearly) nothing below
/// it; its offset is the sensor's height above it. All tolerances are shares of the range, so that a wrong
/// unit of depth changes nothing but the height. Same grid, same answer. Nothing when no such plane is large
/// enough.
std::optional<Plane> findFloor(const PointGrid& grid, const Eigen::Vector3d& up);

}  // namespace roomgraph
