// SPDX-License-Identifier: BSD-3-Clause
// Class layer and keep-out mask as images with the yaml that map_server reads.
#include <nlohmann/json.hpp>
#include <set>

#include "exporters.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "text_numbers.h"

namespace roomgraph {
namespace {

constexpr std::size_t kMostClasses = 100;  // map_server's raw mode takes larger values for unknown
constexpr std::uint8_t kKeptOutGray = 0, kAllowedGray = 255;

CellLayer emptyLayer(const mrpt::maps::COccupancyGridMap2D& grid) {
  CellLayer layer{static_cast<int>(grid.getSizeX()), static_cast<int>(grid.getSizeY()), {}};
  layer.cells.assign(std::size_t{grid.getSizeX()} * grid.getSizeY(), 0);
  return layer;
}

// Images start at the top left: the row of the largest y comes first.
std::string pgmOf(const CellLayer& layer) {
  std::string image = "P5\n" + std::to_string(layer.width) + " " + std::to_string(layer.height) + "\n255\n";
  for (int y = layer.height - 1; y >= 0; --y)
    image.append(reinterpret_cast<const char*>(
                     &layer.cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(layer.width)]),
                 static_cast<std::size_t>(layer.width));
  return image;
}

std::string yamlOf(const mrpt::maps::COccupancyGridMap2D& grid, const std::string& image,
                   const std::string& mode) {
  return "image: " + image + "\nresolution: " + decimals(static_cast<double>(grid.getResolution()), 6) +
         "\norigin: [" + decimals(static_cast<double>(grid.getXMin()), 6) + ", " +
         decimals(static_cast<double>(grid.getYMin()), 6) +
         ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\nmode: " + mode + "\n";
}

double marginOf(const Landmark& landmark, const MapExportOptions& options) {
  const auto named = options.keepout_margin_m.find(landmark.class_name);
  if (named != options.keepout_margin_m.end()) return named->second;
  return landmark.shape.kind == ShapeKind::kPlanar ? -1 : options.usual_margin_m;
}

}  // namespace

std::vector<std::string> classesOf(const CSemanticMap& map) {
  std::set<std::string> names;
  for (const auto& landmark : map.landmarks) names.insert(landmark.class_name);
  return {names.begin(), names.end()};
}

CellLayer classLayer(const CSemanticMap& map, const mrpt::maps::COccupancyGridMap2D& grid) {
  const auto classes = classesOf(map);
  if (classes.size() > kMostClasses) throw RunError("more than 100 classes do not fit into a semantic layer");
  std::vector<const Landmark*> likeliest_last;
  for (const auto& landmark : map.landmarks) likeliest_last.push_back(&landmark);
  std::stable_sort(likeliest_last.begin(), likeliest_last.end(),
                   [](const Landmark* a, const Landmark* b) { return a->existence < b->existence; });
  CellLayer layer = emptyLayer(grid);
  for (const Landmark* landmark : likeliest_last) {
    const auto number =
        std::lower_bound(classes.begin(), classes.end(), landmark->class_name) - classes.begin() + 1;
    forCellsNear(grid, footprintOf(*landmark), 0,
                 [&](int x, int y) { layer.at(x, y) = static_cast<std::uint8_t>(number); });
  }
  return layer;
}

CellLayer keepoutLayer(const CSemanticMap& map, const mrpt::maps::COccupancyGridMap2D& grid,
                       const MapExportOptions& options) {
  CellLayer layer = emptyLayer(grid);
  for (const auto& landmark : map.landmarks) {
    const double margin = marginOf(landmark, options);
    if (margin >= 0)
      forCellsNear(grid, footprintOf(landmark), margin, [&](int x, int y) { layer.at(x, y) = 1; });
  }
  return layer;
}

void writeSemanticLayer(const CSemanticMap& map, const ObjectDatabase& database,
                        const std::filesystem::path& folder) {
  const auto grid = gridOf(map);
  nlohmann::ordered_json legend{{"image", "semantic.pgm"}, {"classes", {{{"value", 0}, {"class", nullptr}}}}};
  int value = 0;
  for (const auto& name : classesOf(map))
    legend["classes"].push_back({{"value", ++value}, {"class", name}, {"color", colorOf(database, name)}});
  writeFileAtomically(folder / "semantic.pgm", pgmOf(classLayer(map, grid)));
  writeFileAtomically(folder / "semantic.yaml", yamlOf(grid, "semantic.pgm", "raw"));
  writeFileAtomically(folder / "semantic_legend.json",
                      legend.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

void writeKeepout(const CSemanticMap& map, const MapExportOptions& options,
                  const std::filesystem::path& folder) {
  const auto grid = gridOf(map);
  CellLayer layer = keepoutLayer(map, grid, options);
  for (auto& cell : layer.cells) cell = cell ? kKeptOutGray : kAllowedGray;
  writeFileAtomically(folder / "keepout.pgm", pgmOf(layer));
  writeFileAtomically(folder / "keepout.yaml", yamlOf(grid, "keepout.pgm", "scale"));
}

}  // namespace roomgraph
