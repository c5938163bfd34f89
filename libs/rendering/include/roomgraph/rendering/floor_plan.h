// SPDX-License-Identifier: BSD-3-Clause
// A floor plan to scale on a page that a printer has.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

struct FloorPlanOptions {
  double scale = 50;          ///< 1 : scale
  std::string page = "auto";  ///< one of pageNames()
  std::string title;          ///< in the title block
};

/// "auto" and the sheets of ISO 216 that it chooses from: "A4" to "A0".
const std::vector<std::string>& pageNames();

/// Writes a PDF with the map exactly 1 : scale, upright or lying as it fits: walls, objects with names, path,
/// legend, scale bar, title block. "auto" takes the smallest sheet that is large enough, beyond A0 one as
/// large as needed. Returns the sheet in words: "A3 landscape". Throws RunError: the map does not fit on the
/// sheet (the message names sheet and scale that do), or on any that a PDF can have; empty map; cannot be
/// written.
std::string writeFloorPlan(const CSemanticMap& map, const ObjectDatabase& database,
                           const FloorPlanOptions& options, const std::filesystem::path& pdf);

}  // namespace roomgraph
