// SPDX-License-Identifier: BSD-3-Clause
// The formats, and what files each consists of.
#include "roomgraph/maptools/map_export.h"

#include "exporters.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/mapping/map_files.h"

namespace roomgraph {
namespace {

const std::map<std::string, std::vector<std::string>>& filesOfFormats() {
  static const std::map<std::string, std::vector<std::string>> files{
      {"nav2", {"map.yaml", "map.pgm"}},
      {"semantic", {"semantic.yaml", "semantic.pgm", "semantic_legend.json"}},
      {"keepout", {"keepout.yaml", "keepout.pgm"}},
      {"geojson", {"objects.geojson"}},
      {"csv", {"objects.csv"}},
      {"ply", {"map.ply"}},
      {"svg", {"plan.svg"}},
      {"dxf", {"plan.dxf"}}};
  return files;
}

}  // namespace

const std::vector<std::string>& exportFormats() {
  static const std::vector<std::string> formats{"nav2", "semantic", "keepout", "geojson",
                                                "csv",  "ply",      "svg",     "dxf"};
  return formats;
}

std::vector<std::string> exportedFiles(const std::string& format) {
  const auto found = filesOfFormats().find(format);
  if (found == filesOfFormats().end())
    throw RunError("unknown format '" + format + "'; known: " + join(exportFormats()));
  return found->second;
}

void exportMap(const CSemanticMap& map, const ObjectDatabase& database, const std::string& format,
               const std::filesystem::path& folder, const MapExportOptions& options) {
  const auto file = folder / exportedFiles(format).front();
  if (format == "nav2") saveOccupancyRos(gridOf(map), folder / "map");
  if (format == "semantic") writeSemanticLayer(map, database, folder);
  if (format == "keepout") writeKeepout(map, options, folder);
  if (format == "geojson") writeFileAtomically(file, geojsonText(map));
  if (format == "csv") writeFileAtomically(file, csvText(map));
  if (format == "ply") writeFileAtomically(file, plyText(map, database));
  if (format == "svg") writeFileAtomically(file, svgText(map, database, options.scale));
  if (format == "dxf") writeFileAtomically(file, dxfText(map));
}

std::string colorOf(const ObjectDatabase& database, const std::string& class_name) {
  const ObjectModel* model = database.find(class_name);
  const std::string color = model ? model->color : "";
  const bool usable = color.size() == 7 && color[0] == '#' &&
                      color.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  return usable ? color : "#888888";
}

}  // namespace roomgraph
