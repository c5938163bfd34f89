// SPDX-License-Identifier: BSD-3-Clause
// What depth rays and lidar beams say of the volume of a landmark, and of the space around it.
#pragma once

#include <vector>

#include "roomgraph/estimation/existence.h"
#include "roomgraph/estimation/landmark_continuation.h"
#include "space_memory.h"

namespace roomgraph {

/// Points all over the volume of a shape, a little inside, m, in the object's frame.
std::vector<Eigen::Vector3d> volumePoints(const ObjectShape& shape);

/// Sets what follows from rays. Without depth images what they would say of most landmarks is taken. Beams alone say
/// what is crossed where images saw nothing of it. `solid_share`: of the height of its class, from the ground.
void setRays(ExistenceEvidence& evidence, const Landmark& landmark, double solid_share,
             const PosedViews& views);
/// The same of the place of a landmark of an earlier map.
void setRays(PlaceLook& look, const Landmark& landmark, double solid_share, const PosedViews& views);

}  // namespace roomgraph
