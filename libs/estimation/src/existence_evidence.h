// SPDX-License-Identifier: BSD-3-Clause
// Evidence for and against landmarks from their sightings and from the rays through and around them.
#pragma once

#include "roomgraph/estimation/existence.h"
#include "roomgraph/estimation/landmark_continuation.h"
#include "roomgraph/estimation/object_frames.h"
#include "roomgraph/observations/object_database.h"
#include "space_memory.h"

namespace roomgraph {

/// One for each landmark, in order. `views`: of the same run, with the poses that the landmarks were
/// estimated with. `searched`: images that the detector saw, in order; of such as it did not look for a landmark's class in, no miss counts.
std::vector<ExistenceEvidence> existenceEvidence(const std::vector<Landmark>& landmarks,
                                                 const ObjectFrames& frames,
                                                 const KeyPoses& poses, const PosedViews& views,
                                                 const ObjectDatabase& database,
                                                 const std::vector<SearchedImage>& searched = {});

/// What images and scans saw of the place of a landmark of an earlier map. `searched`: times of the images
/// that a detector saw, `sighted`: of those with the landmark in them, both in order.
PlaceLook lookAt(const Landmark& landmark, const PosedViews& views, const std::vector<double>& searched,
                 const std::vector<double>& sighted, const ObjectDatabase& database);

}  // namespace roomgraph
