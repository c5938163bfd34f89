// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph snapshot`: PNG of a saved map from above, in orbit or from the robot.
#include <filesystem>
#include <iostream>
#include <memory>
#include <tuple>

#include "commands.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/rendering/snapshot.h"
#include "run_report.h"
#include "shared_files.h"

namespace roomgraph {
namespace {

struct SnapshotArguments {
  std::string map, output, view = "top", size = "1280x960", objects, title;
};

SnapshotOptions toOptions(const SnapshotArguments& arguments) {
  SnapshotOptions options;
  options.view = arguments.view == "orbit"   ? SnapshotView::kOrbit
                 : arguments.view == "robot" ? SnapshotView::kRobot
                                             : SnapshotView::kTop;
  std::tie(options.width, options.height) = sizeInPixels(arguments.size);
  options.title = arguments.title;
  const auto ending = std::filesystem::path(arguments.output).extension();
  if (ending != ".png" && ending != ".PNG")
    throw ConfigError("--output " + arguments.output + ": a picture is a PNG: name it something.png");
  return options;
}

}  // namespace

void addSnapshotCommand(CLI::App& app) {
  auto arguments = std::make_shared<SnapshotArguments>();
  auto* command = app.add_subcommand("snapshot", "Picture of a map (off-screen, no display needed)");
  command->add_option("map", arguments->map, "Map written by run (map.rgmap)")->required();
  command->add_option("-o,--output", arguments->output, "PNG to write")->required();
  command
      ->add_option("--view", arguments->view, "From above, obliquely, or from behind the robot's last pose")
      ->check(CLI::IsMember({"top", "orbit", "robot"}))
      ->capture_default_str();
  command->add_option("--size", arguments->size, "WIDTHxHEIGHT, px")->capture_default_str();
  command->add_option("--objects", arguments->objects,
                      "Object database with the classes' colours (default: objects.ini beside the map, else "
                      "the shipped one)");
  command->add_option("--title", arguments->title, "Title; default: the name of the recording");
  command->footer(
      "Example:\n  roomgraph snapshot out/lab/map.rgmap -o lab.png --view orbit --size 1920x1080");
  command->callback([arguments] {
    SnapshotOptions options = toOptions(*arguments);
    const CSemanticMap map = loadMap(arguments->map);
    if (options.title.empty()) options.title = map.origin;
    const auto colours = ObjectDatabase::fromFile(objectsFileOf(arguments->map, arguments->objects));
    renderSnapshot(map, colours, options, arguments->output);
    std::cout << arguments->output << ": " << options.width << "x" << options.height << " px, "
              << describeObjects(map.landmarks) << "\n";
  });
}

}  // namespace roomgraph
