// SPDX-License-Identifier: BSD-3-Clause
// Figures of a map: area, objects, path, provenance.
#include "map_info.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "roomgraph/core/checksum.h"
#include "roomgraph/observations/path_length.h"
#include "run_report.h"

namespace roomgraph {
namespace {

struct MapFigures {
  double free_m2 = 0, occupied_m2 = 0, path_m = 0, duration_s = 0;
};

MapFigures figuresOf(const CSemanticMap& map) {
  MapFigures out;
  if (map.occupancy) {
    const double cell = static_cast<double>(map.occupancy->getResolution());
    for (unsigned y = 0; y < map.occupancy->getSizeY(); ++y)
      for (unsigned x = 0; x < map.occupancy->getSizeX(); ++x) {
        const float p_free = map.occupancy->getCell(static_cast<int>(x), static_cast<int>(y));
        (p_free > 0.5f ? out.free_m2 : out.occupied_m2) += std::abs(p_free - 0.5f) > 0.15f ? cell * cell : 0;
      }
  }
  const auto& poses = map.world_from_robot;
  out.path_m = pathLength(poses);
  if (!poses.empty()) out.duration_s = poses.back().t - poses.front().t;
  return out;
}

nlohmann::ordered_json gridJson(const mrpt::maps::COccupancyGridMap2D& grid) {
  return {{"width", grid.getSizeX()},  {"height", grid.getSizeY()}, {"resolution_m", grid.getResolution()},
          {"x_min_m", grid.getXMin()}, {"y_min_m", grid.getYMin()}, {"x_max_m", grid.getXMax()},
          {"y_max_m", grid.getYMax()}};
}

}  // namespace

std::string describeMap(const CSemanticMap& map, const std::filesystem::path& file) {
  const MapFigures figures = figuresOf(map);
  std::ostringstream out;
  char line[200];
  out << file.string() << ": map of " << (map.origin.empty() ? "an unnamed recording" : map.origin)
      << (map.planar ? "" : " (handheld)") << "\n";
  if (const auto& grid = map.occupancy) {
    std::snprintf(
        line, sizeof line,
        "grid: %u x %u cells of %g m, x %.2f to %.2f m, y %.2f to %.2f m; %.1f m2 free, %.1f m2 occupied\n",
        grid->getSizeX(), grid->getSizeY(), static_cast<double>(grid->getResolution()),
        static_cast<double>(grid->getXMin()), static_cast<double>(grid->getXMax()),
        static_cast<double>(grid->getYMin()), static_cast<double>(grid->getYMax()), figures.free_m2,
        figures.occupied_m2);
    out << line;
  } else {
    out << "grid: none\n";
  }
  out << describeObjects(map.landmarks) << "\n";
  std::snprintf(line, sizeof line, "path: %zu poses, %.1f m, %.1f s\n", map.world_from_robot.size(),
                figures.path_m, figures.duration_s);
  out << line << "image views to re-localise by: " << map.views.size()
      << "; configuration: " << (map.provenance.config.empty() ? "none" : "kept, see --json")
      << "\nwritten by: "
      << (map.provenance.program.empty() ? "an early version, which left no trace" : map.provenance.program)
      << "\n";
  for (const auto& step : map.provenance.history) out << "history: " << step << "\n";
  return out.str();
}

std::string mapInfoJson(const CSemanticMap& map, const std::filesystem::path& file) {
  const MapFigures figures = figuresOf(map);
  std::map<std::string, int> classes;
  for (const auto& landmark : map.landmarks) ++classes[landmark.class_name];
  const nlohmann::ordered_json json{
      {"file", file.filename().string()},
      {"file_sha256", sha256OfFile(file)},
      {"recording", map.origin},
      {"planar", map.planar},
      {"grid", map.occupancy ? gridJson(*map.occupancy) : nlohmann::ordered_json(nullptr)},
      {"free_m2", figures.free_m2},
      {"occupied_m2", figures.occupied_m2},
      {"objects", map.landmarks.size()},
      {"objects_by_class", classes},
      {"poses", map.world_from_robot.size()},
      {"path_m", figures.path_m},
      {"image_views", map.views.size()},
      {"duration_s", figures.duration_s},
      {"program", map.provenance.program},
      {"history", map.provenance.history},
      {"config", map.provenance.config},
      {"objects_ini", map.provenance.objects}};
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace roomgraph
