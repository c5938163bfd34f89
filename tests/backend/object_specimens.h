// SPDX-License-Identifier: BSD-3-Clause
// Specimens of the residuals of points, boxes, sizes and marginal priors.
#pragma once

#include "residual_specimens.h"

namespace roomgraph::test {

// Specimens of the factors of points, extents and priors; those of poses and places are in
// residual_specimens.cpp.
Specimen sizeAtMeasurement(Random& random);
Specimen sizeByHand();
Specimen boxAtMeasurement(Random& random);
Specimen boxByHand();
Specimen cameraPointAtMeasurement(Random& random);
Specimen cameraPointByHand();
Specimen pointLandmarkAtMeasurement(Random& random);
Specimen sideAtMeasurement(Random& random);
Specimen sideByHand();
Specimen pointLandmarkByHand();
Specimen marginalPriorAtMeasurement(Random& random);
Specimen marginalPriorByHand();

}  // namespace roomgraph::test
