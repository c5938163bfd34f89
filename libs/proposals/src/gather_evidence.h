// SPDX-License-Identifier: BSD-3-Clause
// Collection of the evidence about one detection from its frame.
#pragma once

#include "roomgraph/observations/frame.h"
#include "roomgraph/proposals/box_evidence.h"

namespace roomgraph {

/// Depth points above this height, m over the ground, belong to something that stands on it.
inline constexpr double kStanding_m = 0.12;

/// Depth mask, edges, and cut and hidden sides of a detection's box. `model` outlives the evidence.
BoxEvidence gatherEvidence(const Frame& frame, const Detection& detection, const ObjectModel& model,
                           const Plane& ground);
/// The same box with other points taken for the object; hidden sides are determined again.
BoxEvidence withMask(const BoxEvidence& evidence, const DepthMask& mask, const Frame& frame);

}  // namespace roomgraph
