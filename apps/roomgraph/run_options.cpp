// SPDX-License-Identifier: BSD-3-Clause
// Declarations of the options of `run`, and options from the words of an earlier call.
#include "run_options.h"

#include "commands.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

// Further files, mostly for other programs.
void addFileOptions(CLI::App& command, RunOptions& options) {
  command.add_option("--save-detections", options.detections,
                     "also write this rawlog of nothing but what the detector found, for --set "
                     "detection.file=FILE.rawlog; none when interrupted");
  command.add_option("--progress-file", options.progress,
                     "file that holds the share of the replay that is done, for programs that watch");
}

// What takes the place of the recorded calibration.
void addCalibrationOptions(CLI::App& command, RunOptions& options) {
  command.add_option("--pose", options.poses,
                     "place of a sensor on the robot, SENSOR=x,y,z,yaw,pitch,roll (m, deg), instead of the "
                     "recorded one; may be repeated");
  command.add_option("--calibration", options.calibration,
                     "file of 'roomgraph calibrate': sensor poses, time offsets, wheels and depth in place of the "
                     "recorded ones; --pose goes before it");
}

// What keeps a run alive, and takes it up again.
void addCheckpointOptions(CLI::App& command, RunOptions& options) {
  command
      .add_option("--checkpoint", options.checkpoint_s,
                  "put what was computed safely on the disk every so many seconds, for --resume; 0: none "
                  "(default: 30)")
      ->check(atLeastZero());
  command.add_option(
      "--resume", options.resume,
      "go on with the run whose checkpoint is in this folder; INPUT and all else are as they were");
}

template <class Value>
void replace(Value& before, const Value& now) {
  if (now != Value()) before = now;
}

}  // namespace

void declareRunOptions(CLI::App& command, RunOptions& options) {
  command.add_option("INPUT", options.input, "rawlog, plain or gzipped");  // required: but with --resume
  command.add_option("-o,--output", options.output, "folder for the results");
  command.add_option("--config", options.config, "configuration (default: the installed config.ini)");
  command.add_option("--set", options.overrides, "override: section.key=value; may be repeated");
  addCalibrationOptions(command, options);
  command.add_option("--map", options.map,
                     "map.rgmap of an earlier run, which this one continues once objects, scans or images "
                     "tell where in it the "
                     "robot is; OUT/map.rgmap then holds both, in the frame of the earlier one");
  command.add_option(
      "--models", options.networks.models,
      "model folder, whose networks run when none is named and the recording has no boxes (default: "
      "roomgraph/models in $XDG_DATA_HOME or ~/.local/share)");
  command.add_option("--catalogue", options.networks.catalogue,
                     "catalogue of networks (default: the installed networks.json)");
  command.add_option("--threads", options.threads, "upper limit of threads; 0: all cores")
      ->check(atLeastZero());
  command.add_option("--from", options.span.from_s, "start this many seconds after the first record")
      ->check(atLeastZero());
  command
      .add_option("--until", options.span.until_s,
                  "stop this many seconds after the first record; 0: the end")
      ->check(atLeastZero());
  command.add_option("--record-detections", options.recording,
                     "also write this rawlog: the input with what the detector found; a run of it needs no "
                     "network");
  addFileOptions(command, options);
  addCheckpointOptions(command, options);
  command.add_option("--debug-images", options.pictures,
                     "folder for a picture of every frame: boxes, masks, edges, shapes, what went wrong");
  command.add_flag("--quiet", options.quiet, "no progress");
  command.add_flag("--no-snapshot", options.no_snapshot, "do not render snapshot.png");
  command.add_flag("--no-report", options.no_report, "do not write report.html, nor look for what is wrong with the recording");
  command.footer(
      "Examples:\n"
      "  roomgraph run lab.rawlog -o out/lab\n"
      "  roomgraph run lab.rawlog -o out/lidar --set tracking.enabled=false --set detection.enabled=false\n"
      "  roomgraph run lab.rawlog -o out/lab --set detection.models=nanodet-plus-m-1.5x_416.onnx\n"
      "  roomgraph run lab.rawlog -o out/fast --set detection.models=nanodet-plus-m-1.5x_416.onnx \\\n"
      "      --set detection.every_nth_frame=3 --debug-images out/fast/pictures\n"
      "Networks installed by 'roomgraph models fetch' need not be named:\n"
      "  roomgraph run lab.rawlog -o out/lab --models /media/usb/models\n"
      "Run the network once, then as often as you like without it:\n"
      "  roomgraph run lab.rawlog -o out/lab --set detection.models=nanodet-plus-m-1.5x_416.onnx \\\n"
      "      --record-detections lab_boxes.rawlog\n"
      "  roomgraph run lab_boxes.rawlog -o out/again\n"
      "The same place another day: continues the map of the first run:\n"
      "  roomgraph run later.rawlog -o out/later --map out/lab/map.rgmap\n"
      "The same again, from the files of a run:\n"
      "  roomgraph run lab.rawlog -o out/again --config out/lab/config.ini\n"
      "After a crash, a power cut, a full disk, or Ctrl-C, with the results that an undisturbed run gives:\n"
      "  roomgraph run --resume out/lab\n"
      "Ctrl-C (or SIGTERM, SIGHUP) ends the replay; the results then cover what was replayed, and the exit "
      "code is 4.");
}

RunOptions withWordsOf(const std::vector<std::string>& words, const RunOptions& now) {
  RunOptions out;
  CLI::App command;
  declareRunOptions(command, out);
  // From the last word on, as CLI11 wants it.
  std::vector<std::string> arguments(words.rbegin(), words.size() > 2 ? words.rend() - 2 : words.rbegin());
  try {
    command.parse(arguments);
  } catch (const CLI::ParseError& error) {
    throw InputError(std::string("the command line of the interrupted run makes no sense: ") + error.what());
  }
  for (const auto& [before, said] : std::initializer_list<std::pair<std::string*, const std::string*>>{
           {&out.config, &now.config},
           {&out.map, &now.map},
           {&out.calibration, &now.calibration},
           {&out.recording, &now.recording},
           {&out.detections, &now.detections},
           {&out.pictures, &now.pictures},
           {&out.networks.models, &now.networks.models},
           {&out.networks.catalogue, &now.networks.catalogue}})
    replace(*before, *said);
  out.overrides.insert(out.overrides.end(), now.overrides.begin(), now.overrides.end());
  out.poses.insert(out.poses.end(), now.poses.begin(), now.poses.end());
  replace(out.threads, now.threads);
  replace(out.span.from_s, now.span.from_s);
  replace(out.span.until_s, now.span.until_s);
  replace(out.checkpoint_s, now.checkpoint_s);
  out.progress = now.progress;
  out.resume = now.resume;
  out.quiet = now.quiet;
  out.no_snapshot = out.no_snapshot || now.no_snapshot;
  out.no_report = out.no_report || now.no_report;
  return out;
}

}  // namespace roomgraph
