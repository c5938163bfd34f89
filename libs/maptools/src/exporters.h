// SPDX-License-Identifier: BSD-3-Clause
// One writer for each format of a map export.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "region.h"
#include "roomgraph/maptools/map_export.h"

namespace roomgraph {

/// A grid layer: one byte per cell, rows from the smallest y.
struct CellLayer {
  int width = 0, height = 0;
  std::vector<std::uint8_t> cells;
  std::uint8_t& at(int x, int y) {
    return cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// Classes of the map's objects in alphabetical order: class i has number i + 1 in the semantic layer.
std::vector<std::string> classesOf(const CSemanticMap& map);
/// Number of the class whose object covers the cell, the likeliest one where several do; 0: none.
CellLayer classLayer(const CSemanticMap& map, const mrpt::maps::COccupancyGridMap2D& grid);
/// 1 where a robot's centre is not to be: on and around objects.
CellLayer keepoutLayer(const CSemanticMap& map, const mrpt::maps::COccupancyGridMap2D& grid,
                       const MapExportOptions& options);

// Each returns or writes a whole file; `folder` exists.
void writeSemanticLayer(const CSemanticMap& map, const ObjectDatabase& database,
                        const std::filesystem::path& folder);
void writeKeepout(const CSemanticMap& map, const MapExportOptions& options,
                  const std::filesystem::path& folder);
std::string geojsonText(const CSemanticMap& map);
std::string csvText(const CSemanticMap& map);
std::string plyText(const CSemanticMap& map, const ObjectDatabase& database);
std::string svgText(const CSemanticMap& map, const ObjectDatabase& database, double scale);
std::string dxfText(const CSemanticMap& map);

/// "#rrggbb" of a class; grey when the database does not know it.
std::string colorOf(const ObjectDatabase& database, const std::string& class_name);

}  // namespace roomgraph
