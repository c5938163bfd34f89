// SPDX-License-Identifier: BSD-3-Clause
// The semantic map in the ini of a CMultiMetricMap.
#include <memory>
#include <ostream>

#include "detection_boxes.h"
#include "empty_grid.h"
#include "option_values.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/map_file.h"

namespace roomgraph {

MAP_DEFINITION_REGISTER("roomgraph::CSemanticMap,semanticMap", roomgraph::CSemanticMap)

CSemanticMap::TMapDefinition::TMapDefinition() = default;

void CSemanticMap::TMapDefinition::loadFromConfigFile_map_specific(
    const mrpt::config::CConfigFileBase& source, const std::string& section_prefix) {
  const std::string creating = section_prefix + "_creationOpts";
  file = source.read_string(creating, "file", file);
  objects_file = source.read_string(creating, "objects_file", objects_file);
  const std::string inserting = section_prefix + "_insertOpts", likely = section_prefix + "_likelihoodOpts";
  readOptions(source, inserting, insertion);
  readOptions(source, likely, likelihood);
  if (source.sectionExists(inserting)) grid_insertion.loadFromConfigFile(source, inserting);
  if (source.sectionExists(likely)) grid_likelihood.loadFromConfigFile(source, likely);
}

void CSemanticMap::TMapDefinition::dumpToTextStream_map_specific(std::ostream& out) const {
  out << "file = " << file << "\nobjects_file = " << objects_file << "\n";
  printOptions(insertion, out);
  printOptions(likelihood, out);
  grid_insertion.dumpToTextStream(out);
  grid_likelihood.dumpToTextStream(out);
}

mrpt::maps::CMetricMap* CSemanticMap::internal_CreateFromMapDefinition(
    const mrpt::maps::TMetricMapInitializer& definition) {
  const auto& wanted = dynamic_cast<const TMapDefinition&>(definition);
  auto map = wanted.file.empty() ? std::make_unique<CSemanticMap>()
                                 : std::make_unique<CSemanticMap>(loadMap(wanted.file));
  if (map->provenance.objects.empty() && !wanted.objects_file.empty()) {
    map->provenance.objects = readTextFile(wanted.objects_file);
    ObjectDatabase::fromText(map->provenance.objects, wanted.objects_file);  // throws where it is not right
  }
  map->insertion = wanted.insertion;
  map->likelihood = wanted.likelihood;
  if (!map->occupancy) map->occupancy = emptyGrid(wanted.insertion.grid_resolution_m);
  map->occupancy->insertionOptions = wanted.grid_insertion;
  map->occupancy->likelihoodOptions = wanted.grid_likelihood;
  return map.release();
}

}  // namespace roomgraph
