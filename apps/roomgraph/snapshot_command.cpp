// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph snapshot`: picture, figure or film of a saved map.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <tuple>

#include "commands.h"
#include "interrupts.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/progress.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/rendering/figure.h"
#include "roomgraph/rendering/film.h"
#include "roomgraph/rendering/palette.h"
#include "roomgraph/rendering/snapshot.h"
#include "run_report.h"
#include "shared_files.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

struct SnapshotArguments {
  std::string map, output, film, view = "top", size = "1280x960", objects, title, style = "screen",
                                 palette = "auto";
  double fps = 25, seconds = 20, speed = 0;
  bool quiet = false;
};

bool isPaper(const SnapshotArguments& arguments) {
  return arguments.style == "paper";
}

std::string endingOf(const std::string& file) {
  std::string ending = fs::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending;
}

/// An ending that is no video's is more likely a mistake than the name of a folder.
void checkFilm(const std::string& film) {
  const std::string ending = endingOf(film);
  if (ending.empty() || ending == ".mp4" || ending == ".webm" || ending == ".avi" || fs::is_directory(film))
    return;
  throw ConfigError("--film " + film +
                    ": name it something.mp4, something.webm or something.avi, or name a folder " +
                    "for numbered PNGs (one with a dot in its name must be there already)");
}

SnapshotOptions toOptions(const SnapshotArguments& arguments) {
  SnapshotOptions options;
  options.view = arguments.view == "orbit"   ? SnapshotView::kOrbit
                 : arguments.view == "robot" ? SnapshotView::kRobot
                                             : SnapshotView::kTop;
  std::tie(options.width, options.height) = sizeInPixels(arguments.size);
  options.title = arguments.title;
  return options;
}

void check(const SnapshotArguments& arguments) {
  if (arguments.output.empty() && arguments.film.empty())
    throw ConfigError("say with --output or with --film what is to be made");
  checkFilm(arguments.film);
  const std::string ending = endingOf(arguments.output);
  const bool vector = ending == ".svg" || ending == ".pdf";
  if (!arguments.output.empty() && ending != ".png" && !vector)
    throw ConfigError("--output " + arguments.output +
                      ": name it something.png, something.svg or something.pdf");
  if (arguments.view == "top") return;
  if (vector)
    throw ConfigError("--output " + arguments.output + ": " + ending + " is drawn from above: --view top");
  if (isPaper(arguments)) throw ConfigError("--style paper is drawn from above: --view top");
}

/// map.rgmap, of a run when its folder was named.
fs::path mapFileOf(const std::string& named) {
  return fs::is_directory(named) ? fs::path(named) / "map.rgmap" : fs::path(named);
}

ObjectDatabase coloursFor(const SnapshotArguments& arguments, const fs::path& map) {
  const auto database = ObjectDatabase::fromFile(objectsFileOf(map, arguments.objects));
  const bool safe = arguments.palette == "safe" || (arguments.palette == "auto" && isPaper(arguments));
  return safe ? palette::withSafeColors(database) : database;
}

void draw(const SnapshotArguments& arguments, const CSemanticMap& map, const ObjectDatabase& colours,
          const SnapshotOptions& options) {
  const bool rendered = !isPaper(arguments) && endingOf(arguments.output) == ".png";
  const auto style = isPaper(arguments) ? FigureStyle::kPaper : FigureStyle::kScreen;
  FigureSize size{options.width, options.height};
  if (rendered)
    renderSnapshot(map, colours, options, arguments.output);
  else
    size = writeFigure(map, colours, {style, options.width, options.height, options.title}, arguments.output);
  std::cout << arguments.output << ": " << size.width << "x" << size.height << " px, "
            << describeObjects(map.landmarks) << "\n";
}

/// What was measured when; without the file of a run, first sightings are those of the map.
std::vector<MapSighting> sightingsBeside(const fs::path& map) {
  const fs::path file = map.parent_path() / "associations.jsonl";
  return fs::exists(file) ? readSightings(file) : std::vector<MapSighting>{};
}

void film(const SnapshotArguments& arguments, const CSemanticMap& map, const ObjectDatabase& colours,
          const SnapshotOptions& picture, const fs::path& map_file) {
  FilmOptions options{picture, isPaper(arguments) ? FigureStyle::kPaper : FigureStyle::kScreen, arguments.fps,
                      arguments.seconds, arguments.speed};
  catchInterrupts();
  Progress line(arguments.quiet ? nullptr : &std::cerr, "film", "", 1);
  const FilmResult made =
      writeFilm(map, sightingsBeside(map_file), colours, options, arguments.film, [&](double share) {
        line.update(share);
        return interrupted();
      });
  line.finish();
  std::cout << arguments.film << ": " << made.frames << " frames of " << made.width << "x" << made.height
            << " px, " << made.frames / options.fps << " s\n";
  if (made.frames < made.asked_for)
    throw Interrupted("interrupted: the film shows the first " + std::to_string(made.frames) + " of " +
                      std::to_string(made.asked_for) + " frames");
}

void snapshot(const SnapshotArguments& arguments) {
  check(arguments);
  SnapshotOptions options = toOptions(arguments);
  const fs::path file = mapFileOf(arguments.map);
  const CSemanticMap map = loadMap(file);
  const auto colours = coloursFor(arguments, file);
  requireOther(arguments.output, {file});
  requireOther(arguments.film, {file});
  // Papers have a caption below the figure.
  if (options.title.empty() && !isPaper(arguments)) options.title = map.origin;
  if (!arguments.output.empty()) draw(arguments, map, colours, options);
  if (!arguments.film.empty()) film(arguments, map, colours, options, file);
}

void addFilmOptions(CLI::App& command, SnapshotArguments& a) {
  command.add_option(
      "--film", a.film,
      "film of the run: .mp4, .webm or .avi, or a folder for numbered PNGs; path and map grow, objects "
      "appear when they are first seen");
  command.add_option("--fps", a.fps, "film: pictures per second")
      ->check(CLI::Range(1.0, 120.0))
      ->capture_default_str();
  command.add_option("--seconds", a.seconds, "film: how long the robot's way takes in it")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command.add_option("--speed", a.speed, "film: times real time, instead of --seconds")
      ->check(CLI::Range(0.01, 1000.0));
  command.add_flag("--quiet", a.quiet, "no progress");
}

}  // namespace

void addSnapshotCommand(CLI::App& app) {
  auto arguments = std::make_shared<SnapshotArguments>();
  auto* command = app.add_subcommand("snapshot", "Picture, figure or film of a map (no display needed)");
  command->add_option("map", arguments->map, "Map written by run (map.rgmap), or the folder of a run")
      ->required();
  command->add_option("-o,--output", arguments->output, "picture to write: .png, or from above .svg, .pdf");
  command
      ->add_option("--view", arguments->view, "From above, obliquely, or from behind the robot's last pose")
      ->check(CLI::IsMember({"top", "orbit", "robot"}))
      ->capture_default_str();
  command
      ->add_option("--style", arguments->style,
                   "screen, or paper: white, thin lines, a symbol for each class, numbers for names")
      ->check(CLI::IsMember({"screen", "paper"}))
      ->capture_default_str();
  command
      ->add_option("--palette", arguments->palette,
                   "colours of the classes: classes (of the object database), safe (told apart by the "
                   "colour-blind too), "
                   "auto: safe on paper")
      ->check(CLI::IsMember({"auto", "classes", "safe"}))
      ->capture_default_str();
  command
      ->add_option("--size", arguments->size,
                   "WIDTHxHEIGHT, px; of .svg, .pdf and paper: at most, 96 px an inch")
      ->capture_default_str();
  command->add_option("--objects", arguments->objects,
                      "Object database with the classes' colours (default: objects.ini beside the map, else "
                      "the shipped one)");
  command->add_option("--title", arguments->title,
                      "Title; default: the name of the recording, on paper none");
  addFilmOptions(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  roomgraph snapshot out/lab/map.rgmap -o lab.png --view orbit --size 1920x1080\n"
      "  roomgraph snapshot out/lab/map.rgmap -o lab.pdf --style paper\n"
      "  roomgraph snapshot out/lab --film lab.mp4 --view orbit --seconds 30\n"
      "  roomgraph snapshot out/lab --film frames --speed 2 --fps 10\n"
      "Ctrl-C ends a film early; what was written until then is a film, and the exit code is 4.");
  command->callback([arguments] { snapshot(*arguments); });
}

}  // namespace roomgraph
