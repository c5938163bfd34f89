// SPDX-License-Identifier: BSD-3-Clause
// Point-to-line refinement of a scan against the surfaces of a submap.
#pragma once

#include <optional>

#include "grid_refinement.h"
#include "own_share.h"
#include "surface_cells.h"

namespace roomgraph {

struct SurfaceFit {
  Pose2 map_from_scan;
  /// Inverse covariance of (x, y, yaw) by the scan alone: each return counts by the scatter of its surface and its robust weight,
  /// less what the scatter of the surfaces' directions looks like.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  NeighbourErrors neighbours;
  double trust = 1;  ///< share of the prior's information_per_m2 that counted
};

/// Least squares on robust point-to-line distances, as in Censi 2008 (PLICP), the lines being those of the surfaces around the
/// returns that face the same way. `grid`: the refinement on the submap's grid, from where it starts; `prior`: the one that was used
/// there. It keeps the weight that it had against the direction that the grid constrains least. `own`: by it, returns that lie close
/// together count little more than one, or each for itself.
/// Nothing where fewer than a third of the returns lie on known surfaces.
std::optional<SurfaceFit> refineOnSurfaces(const LocalSurfaces& surfaces, const FacedScan& scan, const GridRefinement& grid,
                                           const PosePrior& prior, const OwnShare& own = {});

/// Of the returns that lie on known surfaces, the share whose surface faces the other way: a wall is seen from behind only by a scan
/// that is out of its place by the wall's thickness.
double shareOnWrongSide(const LocalSurfaces& surfaces, const FacedScan& scan, const Pose2& map_from_scan);

/// A refinement on the grid becomes one on the surfaces, its curvature their information, where there are enough of them; `own` learns
/// from it.
void refineFurther(const LocalSurfaces& surfaces, const FacedScan& scan, const PosePrior& prior, OwnShare& own,
                   GridRefinement& refinement);

}  // namespace roomgraph
