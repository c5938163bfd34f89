// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph view`: a window on a replay, on a finished run or on a map.
#include <dlfcn.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <tuple>

#include "commands.h"
#include "configuration.h"
#include "installed_networks.h"
#include "interrupts.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/pipeline/detection_source.h"
#include "roomgraph/pipeline/read_options.h"
#include "roomgraph/pipeline/settings_json.h"
#include "roomgraph/viewer/recorded_run.h"
#include "roomgraph/viewer/viewer_request.h"
#include "shared_files.h"

namespace roomgraph {
namespace {

struct ViewOptions {
  std::string input, config, objects, size = "1360x840";
  std::vector<std::string> overrides, poses;
  ModelSource networks;
  ReplaySpan span;
  ViewerRequest request;
};

/// The function of the module that opens the window; the module needs a display and libraries that nothing
/// else here does.
ShowViewer* loadWindow() {
#ifdef ROOMGRAPH_GUI
  void* module = dlopen(kViewerModule, RTLD_NOW | RTLD_LOCAL);
  if (!module) throw RunError(std::string("the window cannot be loaded: ") + dlerror());
  auto* show = reinterpret_cast<ShowViewer*>(dlsym(module, kShowViewer));
  if (!show) throw RunError(std::string(kViewerModule) + ": is not the window of this program");
  return show;
#else
  throw RunError(
      "this program was built without its window, which needs the package libmrpt-gui-dev; 'roomgraph "
      "snapshot "
      "MAP.rgmap -o X.png' and 'roomgraph report OUT' need none");
#endif
}

std::unique_ptr<RecordStream> openRecording(const std::filesystem::path& file, const ReadOptions& options) {
  return std::make_unique<RawlogReader>(file, options);
}

void viewMap(ViewOptions& options, const std::filesystem::path& file) {
  const CSemanticMap map = loadMap(file);
  options.request.states = statesOfMap(map);
  const auto database = ObjectDatabase::fromFile(objectsFileOf(file, options.objects));
  options.request.database = &database;
  loadWindow()(options.request);
}

// Stamps and poses of the run are those of sensors that it set when it began anew.
void addSettingsOf(const std::filesystem::path& summary, RecordCorrections& corrections) {
  using nlohmann::ordered_json;
  const auto json = parseJson<ordered_json>(readTextFile(summary), summary.string());
  const auto settings = [&](const char* of) { return json.value(of, ordered_json::object()).value("set", ordered_json::array()); };
  try {
    for (const auto& clock : settings("clocks")) addClocks({clockFrom(clock)}, corrections);
    for (const auto& mount : settings("sensor_poses")) addMounts({mountFrom(mount)}, corrections);
  } catch (const ordered_json::exception& error) {
    throw InputError(summary.string() + ": " + error.what());
  }
}

// Images come from the recording, where it still is.
std::unique_ptr<FrameFinder> imagesOf(const std::filesystem::path& recording,
                                      const std::filesystem::path& folder) {
  if (recording.empty()) return nullptr;  // which a warning has said
  if (!std::filesystem::is_regular_file(recording))
    throw InputError(recording.string() + ": no such file, as seen from this folder");
  const auto config_file = folder / "config.ini";
  Configuration configuration =
      readConfiguration(std::filesystem::exists(config_file) ? config_file.string() : "",
                        {"detection.enabled=false", "pipeline.plugins="});
  const auto setup = makeSetup(configuration.config, configuration.objects_file);
  ReadOptions read = readOptionsOf(setup->options, configuration.config);
  addSettingsOf(folder / "summary.json", read.corrections);
  return std::make_unique<FrameFinder>([=] { return openRecording(recording, read); });
}

void viewRun(ViewOptions& options, const std::filesystem::path& folder) {
  RecordedRun run = readRecordedRun(folder);
  for (const auto& warning : run.warnings) std::cerr << "roomgraph: warning: " << warning << "\n";
  const auto database = ObjectDatabase::fromFile(objectsFileOf(folder / "map.rgmap", options.objects));
  std::unique_ptr<FrameFinder> images;
  try {
    images = imagesOf(run.recording, folder);
  } catch (const Error& error) {
    std::cerr << "roomgraph: warning: no camera images: " << error.what() << "\n";
  }
  options.request.states = std::move(run.states);
  options.request.views = std::move(run.views);
  options.request.database = &database;
  options.request.images = images.get();
  loadWindow()(options.request);
}

void viewReplay(ViewOptions& options) {
  Configuration configuration = readConfiguration(options.config, options.overrides);
  for (const auto& pose : options.poses) placeSensor(configuration.config, pose);
  auto setup = makeRunSetup(configuration, options.input, options.networks).setup;
  const ReadOptions read = readOptionsOf(setup->options, configuration.config);
  auto recording = openRecording(options.input, read);
  ShowViewer* show = loadWindow();
  if (const std::string advice = missingDetections(setup->stages, options.input); !advice.empty())
    std::cerr << "roomgraph: warning: " << advice << "\n";
  FrameFinder images([&] { return openRecording(options.input, read); });
  LiveReplay replay(std::move(recording), std::move(setup), options.span);
  options.request.replay = &replay;
  options.request.database = &replay.database();
  options.request.images = &images;
  show(options.request);
  if (replay.phase() == LiveReplay::Phase::kEnded) replay.rethrow();
}

void check(ViewOptions& options) {
  ViewerRequest& request = options.request;
  std::tie(request.width, request.height) = sizeInPixels(options.size);
  if (options.span.until_s > 0 && options.span.from_s >= options.span.until_s)
    throw ConfigError("--from is not before --until: there is nothing between");
  const auto ending = std::filesystem::path(request.picture).extension();
  if (!request.picture.empty() && ending != ".png" && ending != ".PNG")
    throw ConfigError("--save " + request.picture + ": a picture is a PNG: name it something.png");
  request.save_at_end = !request.picture.empty();
}

void view(ViewOptions& options) {
  check(options);
  const std::filesystem::path input = options.input;
  if (!std::filesystem::exists(input)) throw InputError(options.input + ": no such file or folder");
  options.request.title =
      input.filename().empty() ? input.parent_path().filename().string() : input.filename().string();
  catchInterrupts();
  options.request.interrupted = interrupted;
  const bool folder = std::filesystem::is_directory(input);
  if (!folder && input.extension() != ".rgmap") return viewReplay(options);
  if (!options.config.empty() || !options.overrides.empty() || !options.poses.empty())
    throw ConfigError("--config, --set and --pose are for a recording; " + options.input + " is finished");
  if (folder)
    viewRun(options, input);
  else
    viewMap(options, input);
}

void addReplayOptions(CLI::App& command, ViewOptions& options) {
  command.add_option("--config", options.config,
                     "recording: configuration (default: the installed config.ini)");
  command.add_option("--set", options.overrides, "recording: override, section.key=value; may be repeated");
  command.add_option("--pose", options.poses, "recording: place of a sensor, as in run; may be repeated");
  command.add_option("--models", options.networks.models, "recording: model folder, as in run");
  command.add_option("--catalogue", options.networks.catalogue,
                     "recording: catalogue of networks, as in run");
  command
      .add_option("--from", options.span.from_s, "recording: start this many seconds after the first record")
      ->check(atLeastZero());
  command.add_option("--until", options.span.until_s, "recording: stop there; 0: the end")
      ->check(atLeastZero());
}

}  // namespace

void addViewCommand(CLI::App& app) {
  auto options = std::make_shared<ViewOptions>();
  ViewerRequest& request = options->request;
  auto* command = app.add_subcommand("view", "Window on a replay, on a finished run or on a map");
  command->add_option("INPUT", options->input, "rawlog, folder that run wrote, or map.rgmap")->required();
  addReplayOptions(*command, *options);
  command->add_flag("--paused", request.paused, "do not begin to play");
  command
      ->add_option("--speed", request.speed, "seconds of the recording in a second; 0: as fast as possible")
      ->check(atLeastZero())
      ->capture_default_str();
  command->add_option("--record", request.record, "go to this record (frame or scan) first")
      ->check(atLeastZero());
  auto* follow = command->add_flag("--follow", request.follow, "camera behind the robot");
  command->add_flag("--top", request.top, "camera above the map")->excludes(follow);
  command->add_option("--size", options->size, "of the window: WIDTHxHEIGHT, px")->capture_default_str();
  command->add_option("--objects", options->objects, "map or finished run: object database with the colours");
  command->add_option("--save", request.picture, "PNG of the window, when S is pressed and at --exit-after");
  command
      ->add_option("--exit-after", request.exit_after_s, "close the window after so many seconds; 0: never")
      ->check(atLeastZero());
  command->footer(
      "Examples:\n"
      "  roomgraph view lab.rawlog                       replay, the map growing\n"
      "  roomgraph view lab.rawlog --speed 0 --follow    as fast as possible, behind the robot\n"
      "  roomgraph view out/lab                          a finished run over time\n"
      "  roomgraph view out/lab/map.rgmap --top\n"
      "  roomgraph view lab.rawlog --speed 0 --save lab.png --exit-after 60\n"
      "Keys: space play or pause; left, right one record; Home, End; + and - speed; T, F, O view from above, "
      "follow the\n"
      "robot, orbit; 1 to 9 layers; S save a picture; Esc nothing selected; Q quit. Mouse: left button "
      "turns, right\n"
      "button moves, wheel zooms; a click on an object tells what is known of it.\n"
      "Back in time a replay shows what was known then, a finished run what was seen by then, in the grid and at "
      "the\nplaces of its end. No display: 'snapshot' and 'report' need none.");
  command->callback([options] { view(*options); });
}

}  // namespace roomgraph
