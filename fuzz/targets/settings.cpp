// SPDX-License-Identifier: BSD-3-Clause
// What users write: text of configurations, objects, worlds, calibrations, jobs of a batch, catalogues of
// networks.
#include "../target.h"
#include "roomgraph/batch/job_file.h"
#include "roomgraph/core/config.h"
#include "roomgraph/datasets/calibration_file.h"
#include "roomgraph/mapping/occupancy_options.h"
#include "roomgraph/models/catalogue.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/simulation/world_file.h"

namespace roomgraph::fuzz {
namespace {

ROOMGRAPH_FUZZ_TARGET(config_text) {
  const auto config = Config::fromText(std::string(bytes), "config.ini");
  OccupancyOptions mapping;
  config.read("mapping", mapping);
  for (const auto& entry : config.entries()) config.text(entry.section, entry.key, "");
}

ROOMGRAPH_FUZZ_TARGET(objects) {
  ObjectDatabase::fromText(std::string(bytes));
}

ROOMGRAPH_FUZZ_TARGET(world) {
  const World world = parseWorld(std::string(bytes), "world.json");
  parseWorld(worldText(world), "the same world");
}

ROOMGRAPH_FUZZ_TARGET(calibration) {
  readCalibration(scratchFile("calibration.ini", bytes));
}

ROOMGRAPH_FUZZ_TARGET(jobs) {
  readJobFile(scratchFile("jobs.yaml", bytes));
}

ROOMGRAPH_FUZZ_TARGET(network_catalogue) {
  NetworkCatalogue::fromText(std::string(bytes));
}

}  // namespace
}  // namespace roomgraph::fuzz
