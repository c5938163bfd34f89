// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph map`: info, export and crop of a map file.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "commands.h"
#include "map_commands.h"
#include "map_info.h"
#include "program.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/maptools/map_crop.h"
#include "roomgraph/maptools/map_export.h"
#include "roomgraph/rendering/floor_plan.h"
#include "roomgraph/rendering/palette.h"
#include "roomgraph/rendering/scene_file.h"
#include "run_report.h"
#include "shared_files.h"

namespace roomgraph {
namespace {

// Made by libraries above that of the other formats.
const char* const kSceneFormat = "3dscene";
const char* const kPdfFormat = "pdf";

struct MapExportArguments {
  std::string map, folder, objects, page = "auto";
  std::vector<std::string> formats, margins;
  double scale = 50;
};

struct MapCropArguments {
  std::string map, output;
  std::vector<double> box, polygon;
};

std::vector<std::string> allFormats() {
  auto formats = exportFormats();
  formats.emplace_back(kSceneFormat);
  formats.emplace_back(kPdfFormat);
  return formats;
}

MapExportOptions exportOptions(const MapExportArguments& arguments) {
  MapExportOptions options;
  options.scale = arguments.scale;
  for (const auto& margin : arguments.margins) {
    const auto equals = margin.find('=');
    char* end = nullptr;
    const double value = equals == std::string::npos ? -1 : std::strtod(margin.c_str() + equals + 1, &end);
    const bool off = equals != std::string::npos && margin.substr(equals + 1) == "off";
    const bool number =
        end && end != margin.c_str() + equals + 1 && *end == '\0' && value >= 0 && value <= 10;
    if (equals == 0 || !(off || number))
      throw ConfigError("--margin " + margin + ": give CLASS=METRES, 0 to 10, or CLASS=off");
    options.keepout_margin_m[margin.substr(0, equals)] = off ? -1 : value;
  }
  return options;
}

/// Files that were written, as they are listed.
std::vector<std::string> exportOne(const CSemanticMap& map, const ObjectDatabase& database,
                                   const std::string& format, const MapExportArguments& arguments,
                                   const MapExportOptions& options) {
  const std::filesystem::path folder = arguments.folder;
  if (format == kSceneFormat) {
    saveScene(map, database, folder / "map.3Dscene");
    return {"map.3Dscene"};
  }
  if (format == kPdfFormat) {
    const FloorPlanOptions plan{arguments.scale, arguments.page, map.origin};
    return {"plan.pdf (" + writeFloorPlan(map, palette::withSafeColors(database), plan, folder / "plan.pdf") +
            ")"};
  }
  exportMap(map, database, format, folder, options);
  return exportedFiles(format);
}

// Classes of the map and of the object database.
void requireKnownClasses(const MapExportOptions& options, const CSemanticMap& map, const ObjectDatabase& database) {
  std::vector<std::string> known;
  for (const auto& model : database.models()) known.push_back(model.class_name);
  for (const auto& landmark : map.landmarks) known.push_back(landmark.class_name);
  for (const auto& [name, margin] : options.keepout_margin_m)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw ConfigError("--margin " + name + ": no such class" + didYouMean(name, known));
}

void exportFormatsOf(const MapExportArguments& arguments) {
  const auto options = exportOptions(arguments);
  const auto formats = arguments.formats.empty() ? allFormats() : arguments.formats;
  const CSemanticMap map = loadMap(arguments.map);
  const ObjectDatabase database = databaseOf(map, arguments.map, arguments.objects);
  requireKnownClasses(options, map, database);
  std::error_code error;
  std::filesystem::create_directories(arguments.folder, error);
  if (error) throw RunError("cannot make the folder " + arguments.folder + ": " + error.message());
  std::vector<std::string> written;
  for (const auto& format : formats) {
    for (const auto& file : exportOne(map, database, format, arguments, options)) written.push_back(file);
  }
  std::cout << arguments.folder << ": " << join(written) << "\n";
}

std::vector<Eigen::Vector2d> polygonOf(const MapCropArguments& arguments) {
  if (arguments.box.empty() == arguments.polygon.empty())
    throw ConfigError("say with --box or with --polygon, one of the two, what is to stay");
  for (const double value : arguments.box.empty() ? arguments.polygon : arguments.box)
    if (!std::isfinite(value)) throw ConfigError("--box and --polygon take finite numbers");
  if (const auto& b = arguments.box; !b.empty()) {
    if (!(b[0] < b[2] && b[1] < b[3]))
      throw ConfigError("--box: give XMIN,YMIN,XMAX,YMAX with minima below maxima");
    return {{b[0], b[1]}, {b[2], b[1]}, {b[2], b[3]}, {b[0], b[3]}};
  }
  if (arguments.polygon.size() % 2 != 0 || arguments.polygon.size() < 6)
    throw ConfigError("--polygon: give X,Y of at least three corners: X1,Y1,X2,Y2,X3,Y3");
  std::vector<Eigen::Vector2d> corners;
  for (std::size_t i = 0; i < arguments.polygon.size(); i += 2)
    corners.emplace_back(arguments.polygon[i], arguments.polygon[i + 1]);
  return corners;
}

void crop(const MapCropArguments& arguments) {
  const auto polygon = polygonOf(arguments);
  requireOther(arguments.output, {arguments.map});
  CSemanticMap map = cropped(loadMap(arguments.map), polygon);
  map.provenance.program = programName();
  saveMap(map, arguments.output);
  std::cout << arguments.output << ": " << describeObjects(map.landmarks)
            << (map.occupancy ? "" : "; nothing of the grid") << "\n";
}

void addMapInfo(CLI::App& parent) {
  auto file = std::make_shared<std::string>(), json = std::make_shared<std::string>();
  auto* command = parent.add_subcommand("info", "What a map holds and where it comes from");
  command->add_option("MAP", *file, "map.rgmap")->required();
  command->add_option("--json", *json, "also write all of it, with the configuration, to this file");
  command->footer("Example:\n  roomgraph map info out/lab/map.rgmap --json lab.json");
  command->callback([file, json] {
    const CSemanticMap map = loadMap(*file);
    if (!json->empty()) {
      requireOther(*json, {*file});
      writeFileAtomically(*json, mapInfoJson(map, *file));
    }
    std::cout << describeMap(map, *file);
  });
}

void addMapExport(CLI::App& parent) {
  auto a = std::make_shared<MapExportArguments>();
  auto* command = parent.add_subcommand("export", "Grids for nav2, tables, meshes, drawings");
  command->add_option("MAP", a->map, "map.rgmap")->required();
  command->add_option("-o,--output", a->folder, "folder for the files")->required();
  command->add_option("--format", a->formats, "only these: " + join(allFormats()))
      ->delimiter(',')
      ->check(CLI::IsMember(allFormats()));
  command->add_option(
      "--margin", a->margins,
      "distance kept from objects of a class in the keep-out mask, CLASS=METRES or CLASS=off; may "
      "be repeated (default: 0.1 m, doors off)");
  command->add_option("--scale", a->scale, "drawings are 1 : this")
      ->check(CLI::Range(1.0, 10000.0))
      ->capture_default_str();
  command->add_option("--page", a->page, "sheet of plan.pdf; auto: the smallest that is large enough")
      ->check(CLI::IsMember(pageNames()))
      ->capture_default_str();
  command->add_option(
      "--objects", a->objects,
      "object database with the classes' colours (default: that of the map, else the shipped one)");
  command->footer(
      "Examples:\n"
      "  roomgraph map export out/lab/map.rgmap -o lab\n"
      "  roomgraph map export out/lab/map.rgmap -o lab --format nav2,keepout --margin sofa=0.3 --margin "
      "door=off\n"
      "  roomgraph map export out/lab/map.rgmap -o lab --format pdf --scale 100 --page A4\n"
      "What each file holds: docs/formats.md.");
  command->callback([a] { exportFormatsOf(*a); });
}

void addMapCrop(CLI::App& parent) {
  auto a = std::make_shared<MapCropArguments>();
  auto* command = parent.add_subcommand("crop", "Part of a map in a rectangle or polygon");
  command->add_option("MAP", a->map, "map.rgmap")->required();
  command->add_option("-o,--output", a->output, "map to write")->required();
  command->add_option("--box", a->box, "XMIN,YMIN,XMAX,YMAX in the map's world, m")
      ->delimiter(',')
      ->expected(4);
  command->add_option("--polygon", a->polygon, "X1,Y1,X2,Y2,X3,Y3,…: corners in order, m")->delimiter(',');
  command->footer(
      "Examples:\n"
      "  roomgraph map crop out/lab/map.rgmap -o kitchen.rgmap --box=-1,0,4,5.5\n"
      "  roomgraph map crop out/lab/map.rgmap -o corner.rgmap --polygon=0,0,4,0,4,3");
  command->callback([a] { crop(*a); });
}

}  // namespace

std::string programName() {
  return std::string("roomgraph ") + kVersion + " (" + kRevision + ")";
}

ObjectDatabase databaseOf(const CSemanticMap& map, const std::string& file, const std::string& asked_for) {
  if (asked_for.empty() && !map.provenance.objects.empty())
    return ObjectDatabase::fromText(map.provenance.objects, file + " (objects.ini)");
  return ObjectDatabase::fromFile(objectsFileOf(file, asked_for));
}

void addMapCommand(CLI::App& app) {
  auto* command = app.add_subcommand("map", "Map files: info, export, crop, diff, merge");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  roomgraph map info out/lab/map.rgmap\n"
      "  roomgraph map export out/lab/map.rgmap -o lab\n"
      "  roomgraph map crop out/lab/map.rgmap -o part.rgmap --box=0,0,4,5\n"
      "  roomgraph map diff monday/map.rgmap friday/map.rgmap --svg week.svg\n"
      "  roomgraph map merge monday/map.rgmap friday/map.rgmap -o flat.rgmap");
  addMapInfo(*command);
  addMapExport(*command);
  addMapCrop(*command);
  addMapDiff(*command);
  addMapMerge(*command);
  addMapJoin(*command);
}

}  // namespace roomgraph
