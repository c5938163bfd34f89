// SPDX-License-Identifier: BSD-3-Clause
// Cost functions of points in images, and of landmark box, size and volume.
#include "automatic_cost.h"
#include "costs.h"
#include "object_residuals.h"

namespace roomgraph {

ceres::CostFunction* costOf(const LandmarkSizeFactor& factor) {
  return automatic<LandmarkSizeResidual, 3, 3>(factor);
}
ceres::CostFunction* costOf(const LandmarkBoxFactor& factor, ShapeKind kind) {
  return automatic<LandmarkBoxResidual, 4, 3, 4, 4, 3>(factor, kind);
}
ceres::CostFunction* costOf(const CameraPointFactor& factor) {
  return automatic<CameraPointResidual, 3, 3, 4, 3>(factor);
}
ceres::CostFunction* costOf(const PointLandmarkFactor& factor, ShapeKind kind) {
  return automatic<PointLandmarkResidual, 2, 3, 4, 3>(factor, kind);
}
ceres::CostFunction* costOf(const LandmarkSideFactor& factor, ShapeKind kind) {
  return automatic<LandmarkSideResidual, 1, 3, 4, 4, 3>(factor, kind);
}

}  // namespace roomgraph
