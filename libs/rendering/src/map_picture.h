// SPDX-License-Identifier: BSD-3-Clause
// MapPicture: what a picture shows of a map, and the whole of which it is a part.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/observations/CSemanticMap.h"

namespace roomgraph {

/// What is shown of a map. In a film that is a part of a whole, which says where the camera stands, how wide
/// lines are, and where names are put: nothing jumps while the map grows. Refers to both maps.
struct MapPicture {
  /// All of a map.
  MapPicture(const CSemanticMap& map) : shown(map), whole(map) {}  // NOLINT(google-explicit-constructor)
  MapPicture(const CSemanticMap& part, const CSemanticMap& all) : shown(part), whole(all) {}

  const CSemanticMap& shown;
  const CSemanticMap& whole;
  std::vector<LandmarkId> in_sight;  ///< measured at this moment: a line from the robot to each of them
  std::string note;                  ///< behind the facts below the title
};

}  // namespace roomgraph
