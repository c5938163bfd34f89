// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph run`: replay of a rawlog through SemanticSlam, with progress, map, snapshot and debug output.
#include <tbb/global_control.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <opencv2/core/utility.hpp>
#include <optional>

#include "commands.h"
#include "configuration.h"
#include "installed_networks.h"
#include "interrupts.h"
#include "program.h"
#include "report_defaults.h"
#include "roomgraph/core/error_text.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/mentioned_files.h"
#include "roomgraph/core/progress.h"
#include "roomgraph/core/progress_file.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/pipeline/detection_recording.h"
#include "roomgraph/pipeline/detection_source.h"
#include "roomgraph/pipeline/read_options.h"
#include "roomgraph/pipeline/run_output.h"
#include "roomgraph/rendering/debug_picture.h"
#include "run_report.h"

namespace roomgraph {
namespace {

struct RunOptions {
  std::string input, output, config, map, recording, detections, progress, pictures;
  std::vector<std::string> overrides, poses;
  ModelSource networks;
  int threads = 0;
  ReplaySpan span;
  bool quiet = false, no_snapshot = false, no_report = false;
};

/// Wall-clock time, for people.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void check(const RunOptions& options, const Options& run) {
  if (options.span.until_s > 0 && options.span.from_s >= options.span.until_s)
    throw ConfigError("--from is not before --until: there is nothing between");
  if (!run.tracking.enabled && !run.lidar.enabled && !run.odometry.enabled)
    throw ConfigError("every source of motion is switched off: [tracking], [lidar] and [odometry] enabled");
}

// Files that are read are not to be written.
std::vector<std::filesystem::path> inputsOf(const RunOptions& options, const Configuration& configuration) {
  std::vector<std::filesystem::path> files{options.input, options.map, configuration.file,
                                           configuration.objects_file};
  for (const auto& file : mentionedFiles(configuration.config)) files.push_back(file);
  return files;
}

// Sinks that the command line asks for, besides the run's own files.
struct ExtraSinks {
  std::shared_ptr<DetectionRecording> recording;
  std::shared_ptr<DetectionFile> detections;
  std::shared_ptr<DebugPictures> pictures;
};

ExtraSinks addSinks(const RunOptions& options, const Setup& setup) {
  ExtraSinks sinks;
  if (!options.recording.empty()) {
    if (!setup.stages.detector)
      throw ConfigError("--record-detections needs a detector; [detection] enabled is false");
    sinks.recording =
        std::make_shared<DetectionRecording>(options.input, options.recording, *setup.stages.detector);
  }
  if (!options.detections.empty()) {
    if (!setup.stages.detector)
      throw ConfigError("--save-detections needs a detector; [detection] enabled is false");
    sinks.detections = std::make_shared<DetectionFile>(options.detections, *setup.stages.detector);
  }
  if (!options.pictures.empty()) {
    setup.stages.proposal_generator->keepTraces(true);
    sinks.pictures = std::make_shared<DebugPictures>(options.pictures, setup.database);
  }
  return sinks;
}

ReplayState replayWithProgress(const RunOptions& options, RawlogReader& reader, SemanticSlam& slam) {
  Progress line(options.quiet ? nullptr : &std::cerr, "replay", "", 1);
  ProgressFile file(options.progress);
  const Stopwatch watch;
  const ReplayState state = replay(reader, slam, options.span,
                                   {[&](const ReplayState& now) {
                                      line.update(now.share, describeProgress(now, watch.seconds()));
                                      file.update(now.share);
                                    },
                                    interrupted});
  line.finish();
  return state;
}

// What `info` would say, for the report. Whatever goes wrong with it does not concern the run.
std::optional<std::vector<Finding>> examine(const RunOptions& options, const Options& run) {
  Progress line(options.quiet ? nullptr : &std::cerr, "look at the recording", "%", 100);
  std::optional<std::vector<Finding>> findings;
  try {
    const auto show = [&](double share) {
      line.update(100 * share);
      if (interrupted()) throw Interrupted("while the recording was examined");
    };
    findings = inspectRawlog(options.input, show, readOptionsOf(run).sensor_poses).findings;
  } catch (const std::exception&) {
    findings.reset();
  }
  line.finish();
  return findings;
}

// A run without poses has no result, and there is a reason.
void requireRecords(const RunOptions& options, const Options& run, const ReplayState& replayed,
                    const SlamResult& result) {
  const bool sensors = run.tracking.enabled || run.lidar.enabled;
  const bool nothing_seen = sensors && result.counts.frames + result.counts.scans == 0;
  if (replayed.interrupted && (nothing_seen || result.world_from_robot.empty()))
    throw Interrupted("interrupted before there was a pose; " + options.output + " is as it was");
  char span[96];
  std::snprintf(span, sizeof span, "nothing between %g s and the end (%.1f s)", options.span.from_s,
                replayed.last_t - replayed.start_t);
  if (replayed.records == 0 && options.span.from_s > 0) throw InputError(options.input + ": " + span);
  if (replayed.records == 0 || nothing_seen)
    throw InputError(options.input +
                     ": no usable record of a camera (RGB-D) or a lidar (2D scans); "
                     "'roomgraph info' tells what is inside");
  if (result.world_from_robot.empty()) throw RunError(options.input + ": no pose could be found");
}

std::string whatWasReplayed(const ReplayState& replayed) {
  char text[128];
  std::snprintf(text, sizeof text,
                "interrupted: the results cover %.1f s of the recording, %.0f %% of what was asked for",
                replayed.seconds(), 100 * replayed.share);
  return text;
}

void run(const RunOptions& options) {
  std::optional<tbb::global_control> limit;
  if (options.threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism, options.threads);
    cv::setNumThreads(options.threads);
  }
  Configuration configuration = readConfiguration(options.config, options.overrides);
  for (const auto& pose : options.poses) placeSensor(configuration.config, pose);
  auto [setup, networks, folder] = makeRunSetup(configuration, options.input, options.networks);
  check(options, setup->options);
  RawlogReader reader(options.input, readOptionsOf(setup->options));
  if (const std::string advice = missingDetections(setup->stages, options.input); !advice.empty())
    std::cerr << "roomgraph: warning: " << advice << "\n";
  std::optional<CSemanticMap> earlier;
  if (!options.map.empty()) earlier = loadMap(options.map);
  const auto inputs = inputsOf(options, configuration);
  for (const auto& written : {options.recording, options.detections})
    if (!written.empty()) requireOther(written, inputs);
  catchInterrupts();
  auto output = std::make_shared<RunOutput>(options.output, inputs);
  const ExtraSinks extra = addSinks(options, *setup);
  SemanticSlam slam(std::move(setup));
  if (earlier) slam.setMap(std::move(*earlier));
  slam.addSink(output);
  if (extra.recording) slam.addSink(extra.recording);
  if (extra.detections) slam.addSink(extra.detections);
  if (extra.pictures) slam.addSink(extra.pictures);

  const Stopwatch watch;
  const ReplayState replayed = replayWithProgress(options, reader, slam);
  SlamResult result = slam.finish();
  result.map.origin = std::filesystem::path(options.input).filename().string();
  requireRecords(options, slam.setup().options, replayed, result);
  RunOrigin origin{options.input, kVersion, kRevision, commandLine(), networks, {}};
  if (!options.no_report && !replayed.interrupted) origin.findings = examine(options, slam.setup().options);
  output->writeResult(slam, result, reader.statistics(), replayed, origin);
  const bool drawn = !options.no_snapshot &&
                     drawSnapshot(result.map, slam.setup().database, output->files().pending("snapshot.png"));
  const auto page = output->files().pending("report.html");
  const bool reported = !options.no_report && writeRunReport(page.parent_path(), options.output, page);
  output->files().publish();
  if (extra.recording) extra.recording->finish();
  if (extra.detections && !replayed.interrupted) extra.detections->finish();

  if (!networks.empty()) std::cout << "networks of " << folder.string() << ": " << join(networks) << "\n";
  std::cout << describeRun(result, replayed, reader.statistics(), watch.seconds());
  const std::string detector = slam.setup().stages.detector ? slam.setup().stages.detector->warning() : "";
  std::vector<std::string> warnings = reader.statistics().sensor_warnings;
  warnings.insert(warnings.end(), {reader.statistics().warning, detector});
  for (const std::string& warning : warnings)
    if (!warning.empty()) std::cerr << "roomgraph: warning: " << warning << "\n";
  std::cout << "results in " << options.output;
  if (reported || drawn)
    std::cout << "; look at "
              << (output->files().folder() / (reported ? "report.html" : "snapshot.png")).string();
  std::cout << "\n";
  if (replayed.interrupted) throw Interrupted(whatWasReplayed(replayed));
}

// Further files, mostly for other programs.
void addFileOptions(CLI::App& command, RunOptions& options) {
  command.add_option("--save-detections", options.detections,
                     "also write this rawlog of nothing but what the detector found, for --set "
                     "detection.file=FILE.rawlog; none when interrupted");
  command.add_option("--progress-file", options.progress,
                     "file that holds the share of the replay that is done, for programs that watch");
}

}  // namespace

void addRunCommand(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  auto* command = app.add_subcommand("run", "Replay a rawlog: trajectory, semantic map and picture");
  command->add_option("INPUT", options->input, "rawlog, plain or gzipped")->required();
  command->add_option("-o,--output", options->output, "folder for the results")->required();
  command->add_option("--config", options->config, "configuration (default: the installed config.ini)");
  command->add_option("--set", options->overrides, "override: section.key=value; may be repeated");
  command->add_option("--pose", options->poses,
                      "place of a sensor on the robot, SENSOR=x,y,z,yaw,pitch,roll (m, deg), instead of the "
                      "recorded one; may be repeated");
  command->add_option("--map", options->map,
                      "map.rgmap of an earlier run, which this one continues once objects, scans or images "
                      "tell where in it the "
                      "robot is; OUT/map.rgmap then holds both, in the frame of the earlier one");
  command->add_option(
      "--models", options->networks.models,
      "model folder, whose networks run when none is named and the recording has no boxes (default: "
      "roomgraph/models in $XDG_DATA_HOME or ~/.local/share)");
  command->add_option("--catalogue", options->networks.catalogue,
                      "catalogue of networks (default: the installed networks.json)");
  command->add_option("--threads", options->threads, "upper limit of threads; 0: all cores")
      ->check(atLeastZero());
  command->add_option("--from", options->span.from_s, "start this many seconds after the first record")
      ->check(atLeastZero());
  command
      ->add_option("--until", options->span.until_s,
                   "stop this many seconds after the first record; 0: the end")
      ->check(atLeastZero());
  command->add_option("--record-detections", options->recording,
                      "also write this rawlog: the input with what the detector found; a run of it needs no "
                      "network");
  addFileOptions(*command, *options);
  command->add_option("--debug-images", options->pictures,
                      "folder for a picture of every frame: boxes, masks, edges, shapes, what went wrong");
  command->add_flag("--quiet", options->quiet, "no progress");
  command->add_flag("--no-snapshot", options->no_snapshot, "do not render snapshot.png");
  command->add_flag("--no-report", options->no_report, "do not write report.html");
  command->footer(
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
      "Ctrl-C (or SIGTERM, SIGHUP) ends the replay; the results then cover what was replayed, and the exit "
      "code is 4.");
  command->callback([options] { run(*options); });
}

}  // namespace roomgraph
