// SPDX-License-Identifier: BSD-3-Clause
// Fit of an upright shape to box sides, depth points and size prior; quality of a fit.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "generators.h"

namespace roomgraph {

/// Adjusts place, yaw and size of an upright cylinder or cuboid so that its projection meets the box's uncut
/// sides, the mask's points lie inside, its near side is where the points begin, and its size stays usual for
/// the class (Levenberg-Marquardt). Sets quality and box_iou.
PlacedShape fitShape(const PlacedShape& initial, const BoxEvidence& evidence);

/// Sets quality and box_iou of a hypothesis as it is.
void judge(PlacedShape& placed, const BoxEvidence& evidence);

/// How far the points in the upper part lie towards the back, of the model and of the points in the lower
/// part, in [-1, 1]: a sofa's back rest is its high side. 0 when there are no such points.
double backRestAgreement(const PlacedShape& placed, const std::vector<MaskPoint>& points);

}  // namespace roomgraph
