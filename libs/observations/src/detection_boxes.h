// SPDX-License-Identifier: BSD-3-Clause
// Boxes of an observation in the words of a map.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <memory>
#include <vector>

#include "box_likelihood.h"
#include "roomgraph/observations/CObservationDetections.h"
#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// The detections that an observation is, as a record of its own class or as a comment; null: it is none, or
/// its text is damaged.
std::shared_ptr<const CObservationDetections> detectionsIn(const mrpt::obs::CObservation& observation);

/// The classes that a map was made with; null when it does not say.
std::shared_ptr<const ObjectDatabase> databaseOf(const CSemanticMap& map);

/// The boxes that can show a landmark. Classes of the database that are no landmarks and labels that it does
/// not know are left out; without a database labels are classes.
std::vector<ClassBox> boxesOfLandmarks(const CObservationDetections& detections,
                                          const ObjectDatabase* database);

/// Number of classes that a box of a landmark may have, at least 1.
int labelCount(const CSemanticMap& map, const ObjectDatabase* database);

}  // namespace roomgraph
