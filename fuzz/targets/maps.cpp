// SPDX-License-Identifier: BSD-3-Clause
// Maps: map.rgmap, and occupancy grids of ROS.
#include "../target.h"
#include "roomgraph/core/checksum.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/observations/map_file.h"

namespace roomgraph::fuzz {
namespace {

ROOMGRAPH_FUZZ_TARGET(map) {
  loadMap(scratchFile("map.rgmap", bytes));
}

// With the checksum of whatever the content is: what lies behind it is met.
ROOMGRAPH_FUZZ_TARGET(map_content) {
  const std::string content(bytes);
  const auto map = loadMap(scratchFile("map.rgmap", content + "roomgraph map sha256 " + sha256Of(content)));
  for (const auto& landmark : map.landmarks)
    require(landmark.position.allFinite(), "positions of landmarks are finite");
}

ROOMGRAPH_FUZZ_TARGET(occupancy_map) {
  writeParts(bytes, {"map.yaml", "map.pgm"});
  loadOccupancyRos(scratchFolder() / "map.yaml");
}

}  // namespace
}  // namespace roomgraph::fuzz
