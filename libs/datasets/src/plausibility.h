// SPDX-License-Identifier: BSD-3-Clause
// Plausibility of time stamps and observations: finite numbers of sensible size.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <string>

#include "roomgraph/geometry/plausible_pose.h"

namespace roomgraph {

// What a record of a sensor on a robot can say at all. Everything that reads records asks here before it uses
// one; behind this border numbers are finite and of a size that arithmetic bears.

/// Between 1970 and 2200, s.
bool plausibleTime(double t);

/// Why an observation of a class that is used cannot be true, as problemOf() of a pose does: "sensor pose is not finite", "aperture of 9 rad is
/// impossible (…)", "score of a box is not in [0, 1]"; empty for other classes. Missing images and intrinsics are
/// not looked for.
std::string problemOf(const mrpt::obs::CObservation& observation);

}  // namespace roomgraph
