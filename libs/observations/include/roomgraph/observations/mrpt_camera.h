// SPDX-License-Identifier: BSD-3-Clause
// Intrinsics between PinholeCamera and MRPT's TCamera.
#pragma once

#include <mrpt/img/TCamera.h>

#include "roomgraph/geometry/camera.h"

namespace roomgraph {

/// Pixels; distortion as plumb_bob, none when all its coefficients are zero.
mrpt::img::TCamera toMrpt(const PinholeCamera& camera);
/// The inverse. Other models of distortion are taken for plumb_bob.
PinholeCamera toPinhole(const mrpt::img::TCamera& camera);

}  // namespace roomgraph
