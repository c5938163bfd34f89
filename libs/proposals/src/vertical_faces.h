// SPDX-License-Identifier: BSD-3-Clause
// Directions of the vertical faces of an object.
#pragma once

#include <vector>

#include "roomgraph/proposals/box_evidence.h"

namespace roomgraph {

/// Azimuths of the normals at those depth points that are on vertical faces: planes through their neighbours in the
/// image. What is level, as a seat or a table top, has none; neither have edges. The points are samples of a regular
/// grid of pixels.
VerticalFaces verticalFaces(const std::vector<MaskPoint>& points);

/// How well two directions at right angles fit the faces, against those that fit best, in [0, 1]: each face counts the
/// less the farther its normal is from the nearer direction. Few of them say little: 1 without any.
double faceAgreement(const VerticalFaces& faces, double yaw);

}  // namespace roomgraph
