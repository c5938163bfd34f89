// SPDX-License-Identifier: BSD-3-Clause
// Which side of a placed shape is its front.
#pragma once

#include <vector>

#include "roomgraph/proposals/placed_shape.h"

namespace roomgraph {

/// How far the points in the upper part lie towards the back, of the model and of the points in the lower part, in
/// [-1, 1]: a sofa's back rest is its high side. 0 when there are too few such points.
double backRestAgreement(const PlacedShape& placed, const std::vector<MaskPoint>& points);

/// How well the hypothesis' front agrees with the rule that tells the front of its class (ObjectModel::frontRule()), in
/// [-1, 1]; 0 where nothing tells it.
double frontAgreement(const PlacedShape& placed, const BoxEvidence& evidence);

}  // namespace roomgraph
