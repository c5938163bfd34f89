// SPDX-License-Identifier: BSD-3-Clause
// Intrinsics between PinholeCamera and MRPT's TCamera.
#pragma once

#include <mrpt/img/TCamera.h>

#include "roomgraph/geometry/camera.h"

namespace roomgraph {

/// Pixels; distortion as plumb_bob, none when all its coefficients are zero.
mrpt::img::TCamera toMrpt(const PinholeCamera& camera);
/// The inverse. Of other models of distortion it has the first coefficients only: what they do is to be taken out of the images.
PinholeCamera toPinhole(const mrpt::img::TCamera& camera);

}  // namespace roomgraph
