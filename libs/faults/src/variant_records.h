// SPDX-License-Identifier: BSD-3-Clause
// Observations as another drive would have made them: fewer beams, other side, other direction.
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>

#include "roomgraph/faults/variant.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Takes beams from a scan; its middle stays where it looks.
void thinBeams(mrpt::obs::CObservation2DRangeScan& scan, const VariantOptions& options);

/// As it would be in rooms whose left is their right. False: it is of a kind that cannot be told.
bool mirror(mrpt::obs::CObservation::Ptr& observation);

/// As it would be on the way back; the stamp is the caller's.
void reverseMotion(mrpt::obs::CObservation& observation);

/// The mirrored pose of something on the robot: both frames with -y for y.
Pose3 mirrored(const Pose3& pose);
/// The same of an optical frame, whose x becomes -x.
Pose3 mirroredOptical(const Pose3& pose);

}  // namespace roomgraph
