// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include <tbb/global_control.h>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <opencv2/core/utility.hpp>
#include <optional>

#include "commands.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/progress.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/pipeline/detection_recording.h"
#include "roomgraph/pipeline/read_options.h"
#include "roomgraph/pipeline/record_sorter.h"
#include "roomgraph/pipeline/run_output.h"
#include "roomgraph/rendering/debug_picture.h"
#include "roomgraph/rendering/snapshot.h"
#include "shared_files.h"

namespace roomgraph {
namespace {

volatile std::sig_atomic_t interrupted = 0;

struct RunOptions {
  std::string input, output, config, map, recording, pictures;
  std::vector<std::string> overrides, poses;
  int threads = 0;
  double from_s = 0, until_s = 0;
  bool quiet = false, no_snapshot = false;
};

struct Replay {
  ReadStatistics read;
  double first_t = 0, last_t = 0;
  bool stopped = false;
};

std::string rateText(int records, double span_s, std::chrono::steady_clock::time_point started) {
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  char text[96];
  std::snprintf(text, sizeof text, "%.1f s replayed, %.0f records/s, %.1f x real time", span_s,
                records / elapsed, span_s / elapsed);
  return text;
}

Replay replay(const RunOptions& options, RawlogReader& reader, RecordSorter& sorter, SemanticSlam& slam) {
  Replay done;
  Progress progress(options.quiet ? nullptr : &std::cerr, "replay", "", 1);
  const auto started = std::chrono::steady_clock::now();
  int records = 0;
  std::optional<double> start;
  bool ended = false;
  while (!interrupted) {
    std::optional<Record> record = sorter.pop(ended);
    if (!record && ended) break;
    if (!record) {
      if (auto next = reader.next()) {
        sorter.push(std::move(*next));
      } else {
        ended = true;
      }
      continue;
    }
    const double t = timeOf(*record);
    if (!start) done.first_t = *(start = t);
    if (t - *start < options.from_s) continue;
    if (options.until_s > 0 && t - *start > options.until_s) break;
    slam.process(*record);
    done.last_t = t;
    progress.update(reader.progress(), rateText(++records, t - *start, started));
  }
  progress.finish();
  done.stopped = interrupted != 0;
  done.read = reader.statistics();
  return done;
}

// Sinks that the command line asks for, besides the run's own files.
struct ExtraSinks {
  std::shared_ptr<DetectionRecording> recording;
  std::shared_ptr<DebugPictures> pictures;
};

ExtraSinks addSinks(const RunOptions& options, Stages& stages) {
  ExtraSinks sinks;
  if (!options.recording.empty()) {
    if (!stages.detector)
      throw ConfigError("--record-detections needs a detector; [detection] enabled is false");
    sinks.recording =
        std::make_shared<DetectionRecording>(options.input, options.recording, *stages.detector);
  }
  if (!options.pictures.empty()) {
    stages.proposal_generator->keepTraces(true);
    sinks.pictures = std::make_shared<DebugPictures>(options.pictures, stages.database);
  }
  return sinks;
}

void printSummary(const RunOptions& options, const Replay& replayed, const SlamResult& result,
                  const std::string& detector_warning, double seconds) {
  const auto& counts = result.counts;
  const double span = replayed.last_t - replayed.first_t;
  std::cout << counts.frames << " frames (" << counts.frames_lost << " not tracked), " << counts.scans
            << " scans (" << counts.scans_unmatched << " not matched), " << counts.odometry
            << " odometry readings; " << counts.key_poses << " key poses, " << counts.loop_closures
            << " loop closures, " << result.map.landmarks.size() << " objects\n";
  std::cout << span << " s of data in " << seconds << " s\n";
  for (const auto& [reason, count] : counts.reasons) std::cout << "  " << count << " x " << reason << "\n";
  for (const auto& [reason, count] : replayed.read.skipped)
    std::cout << "  skipped " << count << " x " << reason << "\n";
  std::vector<std::string> warnings = replayed.read.sensor_warnings;
  warnings.insert(warnings.end(), {replayed.read.warning, detector_warning});
  for (const std::string& warning : warnings)
    if (!warning.empty()) std::cerr << "roomgraph: warning: " << warning << "\n";
  if (replayed.stopped) std::cerr << "roomgraph: interrupted; the results cover what was replayed\n";
  std::cout << "results in " << options.output << "\n";
}

void run(const RunOptions& options) {
  std::optional<tbb::global_control> limit;
  if (options.threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism, options.threads);
    cv::setNumThreads(options.threads);
  }
  const std::filesystem::path config_file =
      options.config.empty() ? sharedFile("config.ini") : std::filesystem::path(options.config);
  Config config = Config::fromFile(config_file);
  for (const auto& assignment : options.overrides) config.override(assignment);
  for (const auto& pose : options.poses) placeSensor(config, pose);
  auto stages = makeStages(config, config_file.parent_path());
  const ObjectDatabase database = stages->database;
  RawlogReader reader(options.input, readOptionsOf(*stages));
  RecordSorter sorter(stages->general.lookahead_s);
  auto output = std::make_shared<RunOutput>(options.output);
  const ExtraSinks extra = addSinks(options, *stages);
  SemanticSlam slam(std::move(stages));
  if (!options.map.empty()) slam.setMap(loadMap(options.map));
  slam.addSink(output);
  if (extra.recording) slam.addSink(extra.recording);
  if (extra.pictures) slam.addSink(extra.pictures);
  std::signal(SIGINT, [](int) { interrupted = 1; });
  std::signal(SIGTERM, [](int) { interrupted = 1; });

  const auto started = std::chrono::steady_clock::now();
  const Replay replayed = replay(options, reader, sorter, slam);
  if (extra.recording) extra.recording->finish();
  SlamResult result = slam.finish();
  result.map.origin = std::filesystem::path(options.input).filename().string();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  output->writeResult(slam, result, replayed.read,
                      {{"input", options.input},
                       {"version", ROOMGRAPH_VERSION},
                       {"interrupted", replayed.stopped ? "yes" : "no"}});
  if (result.world_from_robot.empty())
    throw InputError(options.input +
                     ": no usable sensor records (RGB-D, 2D scans); 'roomgraph info' tells what is inside");
  if (!options.no_snapshot)
    renderSnapshot(result.map, database, {.title = result.map.origin}, output->folder() / "snapshot.png");
  const auto& detector = slam.stages().detector;
  printSummary(options, replayed, result, detector ? detector->warning() : "", seconds);
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
  command->add_option(
      "--map", options->map,
      "map.rgmap of an earlier run: results are in its frame once its objects are recognised");
  command->add_option("--threads", options->threads, "upper limit of threads; 0: all cores")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--from", options->from_s, "start this many seconds after the first record")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--until", options->until_s, "stop this many seconds after the first record; 0: the end")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--record-detections", options->recording,
                      "also write this rawlog: the input with what the detector found; to be replayed with "
                      "--set detection.class=RecordedDetector");
  command->add_option("--debug-images", options->pictures,
                      "folder for a picture of every frame: boxes, masks, edges, shapes, what went wrong");
  command->add_flag("--quiet", options->quiet, "no progress");
  command->add_flag("--no-snapshot", options->no_snapshot, "do not render snapshot.png");
  command->footer(
      "Examples:\n"
      "  roomgraph run lab.rawlog -o out/lab\n"
      "  roomgraph run lab.rawlog -o out/lidar --set tracking.enabled=false --set detection.enabled=false\n"
      "  roomgraph run lab.rawlog -o out/lab --set detection.models=nanodet-plus-m_1.5x-416.onnx\n"
      "  roomgraph run lab.rawlog -o out/fast --set detection.models=nanodet-plus-m_1.5x-416.onnx \\\n"
      "      --set detection.every_nth_frame=3 --debug-images out/fast/pictures\n"
      "Run the network once, then as often as you like without it:\n"
      "  roomgraph run lab.rawlog -o out/lab --set detection.models=nanodet-plus-m_1.5x-416.onnx \\\n"
      "      --record-detections lab_boxes.rawlog\n"
      "  roomgraph run lab_boxes.rawlog -o out/again --set detection.class=RecordedDetector\n"
      "Ctrl-C ends the replay; the results then cover what was replayed.");
  command->callback([options] { run(*options); });
}

}  // namespace roomgraph
