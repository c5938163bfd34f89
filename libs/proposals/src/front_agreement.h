// SPDX-License-Identifier: BSD-3-Clause
// Which side of a placed shape is its front.
#pragma once

#include <vector>

#include "roomgraph/proposals/placed_shape.h"

namespace roomgraph {

/// How far the high points lie towards the back of the model, compared with its middle and with the low points, in
/// [-1, 1]: the back rest is the high side. 0 when there are too few high points.
double backRestAgreement(const PlacedShape& placed, const std::vector<MaskPoint>& points);

/// Agreement of the hypothesis' front with the rule of its class (ObjectModel::frontRule()), in [-1, 1]; 0 without a
/// rule.
double frontAgreement(const PlacedShape& placed, const BoxEvidence& evidence);

}  // namespace roomgraph
