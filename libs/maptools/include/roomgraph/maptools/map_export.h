// SPDX-License-Identifier: BSD-3-Clause
// Exports of a map: grids for navigation, tables, meshes, drawings.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

struct MapExportOptions {
  /// Distance kept from objects in the keep-out mask, m, by class; a negative one leaves the class out.
  std::map<std::string, double> keepout_margin_m;
  double usual_margin_m = 0.1;  ///< of classes not named, but planar ones (doors), which are left out
  double scale = 50;            ///< drawings are 1 : scale
};

/// What a map can be exported to: "nav2", "semantic", "keepout", "geojson", "csv", "ply", "svg", "dxf".
const std::vector<std::string>& exportFormats();

/// Files that a format consists of, the main one first.
std::vector<std::string> exportedFiles(const std::string& format);

/// Writes the files of one format into `folder`, which exists. World coordinates, m, rad; grids have the
/// lattice of the map's own, drawings are to scale (docs/formats.md). Throws RunError: unknown format,
/// nothing to draw, cannot be written.
void exportMap(const CSemanticMap& map, const ObjectDatabase& database, const std::string& format,
               const std::filesystem::path& folder, const MapExportOptions& options = {});

}  // namespace roomgraph
