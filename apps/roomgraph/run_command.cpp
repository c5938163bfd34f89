// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph run`: replay of a rawlog through SemanticSlam, with progress, map, snapshot and debug output.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <optional>
#include <utility>

#include "commands.h"
#include "configuration.h"
#include "examination.h"
#include "interrupts.h"
#include "program.h"
#include "report_defaults.h"
#include "roomgraph/core/error_text.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/heap.h"
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
#include "run_beginnings.h"
#include "run_checkpoint.h"
#include "run_options.h"
#include "run_places.h"
#include "run_report.h"
#include "thread_limit.h"

namespace roomgraph {
namespace {

constexpr double kCheckpoint_s = 30;

/// Wall-clock time, for people.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void check(const RunOptions& options) {
  if (options.span.until_s > 0 && options.span.from_s >= options.span.until_s)
    throw ConfigError("--from is not before --until: there is nothing between");
}

// Files that are read are not to be written.
std::vector<std::filesystem::path> inputsOf(const RunOptions& options, const Configuration& configuration) {
  std::vector<std::filesystem::path> files{options.input, options.map, configuration.file,
                                           configuration.objects_file};
  for (const auto& file : mentionedFiles(configuration.config)) files.push_back(file);
  for (const auto& written : {options.recording, options.detections})
    if (!written.empty()) requireOther(written, files);
  return files;
}

// Sinks that the command line asks for, besides the run's own files.
struct ExtraSinks {
  std::shared_ptr<DetectionRecording> recording;
  std::shared_ptr<DetectionFile> detections;
  std::shared_ptr<DebugPictures> pictures;

  void addTo(SemanticSlam& slam) const {
    for (const std::shared_ptr<Sink>& sink :
         {std::shared_ptr<Sink>(recording), std::shared_ptr<Sink>(detections),
          std::shared_ptr<Sink>(pictures)})
      if (sink) slam.addSink(sink);
  }
};

ExtraSinks addSinks(const RunOptions& options, const Setup& setup, const ReadOptions& reading) {
  ExtraSinks sinks;
  if (!options.recording.empty()) {
    if (!setup.stages.detector)
      throw ConfigError("--record-detections needs a detector; [detection] enabled is false");
    sinks.recording =
        std::make_shared<DetectionRecording>(options.input, options.recording, *setup.stages.detector, reading.corrections.time_offsets_s);
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

ReplayState replayWithProgress(const RunOptions& options, RawlogReader& reader, SemanticSlam& slam,
                               RunPlaces& places, const std::function<bool(const ReplayState&)>& ends) {
  Progress line(options.quiet ? nullptr : &std::cerr, "replay", "", 1);
  ProgressFile file(options.progress);
  const Stopwatch watch;
  bool ended = false;
  const ReplayState state = replay(reader, slam, options.span,
                                   {[&](const ReplayState& now) {
                                      line.update(now.share, describeProgress(now, watch.seconds()));
                                      file.update(now.share);
                                      places.look();
                                      ended = ends(now);
                                    },
                                    [&] { return ended || interrupted(); }});
  line.finish();
  places.require();  // what was cut looks like its end
  return state;
}

// A run without poses has no result, and there is a reason.
void requireRecords(const RunOptions& options, const Options& run, const ReplayState& replayed,
                    const SlamResult& result, RunCheckpoint* checkpoint) {
  const bool sensors = run.tracking.enabled || run.lidar.enabled;
  const bool nothing_seen = sensors && result.counts.frames + result.counts.scans == 0;
  if (replayed.interrupted && (nothing_seen || result.world_from_robot.empty()))
    throw Interrupted("interrupted before there was a pose; " + options.output + " is as it was");
  // It would go on to the same end.
  if (checkpoint && (replayed.records == 0 || nothing_seen || result.world_from_robot.empty()))
    checkpoint->discard();
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

std::string whatWasReplayed(const ReplayState& replayed, RunCheckpoint* checkpoint,
                            const std::string& output) {
  char text[128];
  std::snprintf(text, sizeof text,
                "interrupted: the results cover %.1f s of the recording, %.0f %% of what was asked for",
                replayed.seconds(), 100 * replayed.share);
  if (!checkpoint || checkpoint->results().empty()) return text;
  return text + ("; for the whole: roomgraph run --resume " + output);
}

RunOrigin originOf(const RunOptions& options, const std::vector<std::string>& networks,
                   const RunCheckpoint* checkpoint, const RunBeginnings& beginnings, double wall_s) {
  RunOrigin origin{options.input, kVersion, kRevision, checkpoint ? checkpoint->command() : commandLine(),
                   networks};
  origin.resumed = !options.resume.empty();
  if (!origin.resumed) origin.wall_s = wall_s;
  origin.clocks = beginnings.clocks();
  origin.mounts = beginnings.mounts();
  return origin;
}

/// What stays of a run that begins anew.
struct WholeRun {
  RunBeginnings beginnings;
  bool resumes = false;  ///< with the next beginning
  std::vector<std::string> command = commandLine();
  std::optional<Examination> examination;
};

// Of the recording, and of the movements that its sensors measured.
Examination::Findings findingsOf(WholeRun& whole, const SemanticSlam& slam, bool quiet) {
  Examination::Findings out = whole.examination->findings(quiet);
  if (!out) return out;
  for (const ClockSetting& clock : whole.beginnings.clocks()) out->push_back(clockFinding(clock, true));
  for (const MountSetting& mount : whole.beginnings.mounts()) out->push_back(mountFinding(mount, true));
  for (const Finding& finding : slam.movementFindings()) out->push_back(finding);
  std::stable_sort(out->begin(), out->end(), [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
  return out;
}

void printWarnings(const ReadStatistics& read, const std::string& of_detector, const std::vector<Finding>& findings) {
  std::vector<std::string> warnings = read.sensor_warnings;
  warnings.insert(warnings.end(), {read.warning, of_detector});
  for (const Finding& finding : findings)
    if (finding.severity >= Severity::kWarning && finding.place != "file")  // which the reader says itself
      warnings.push_back(finding.place + ": " + finding.what + (finding.hint.empty() ? "" : "; " + finding.hint));
  for (const std::string& warning : warnings)
    if (!warning.empty()) std::cerr << "roomgraph: warning: " << warning << "\n";
}

// Nothing with --checkpoint 0, unless it is to be gone on with.
std::unique_ptr<RunCheckpoint> openCheckpoint(const RunOptions& options, const Setup& setup,
                                              const OutputFolder& files, WholeRun& whole) {
  const double seconds = options.checkpoint_s.value_or(kCheckpoint_s);
  const bool resume = std::exchange(whole.resumes, false);
  std::error_code none;
  const bool there = std::filesystem::exists(files.checkpoint(), none);
  if (there && !resume)
    std::cerr
        << "roomgraph: warning: " << files.folder().string()
        << ": the checkpoint of an unfinished run is there (--resume would go on with it); begun anew\n";
  if (seconds <= 0 && !resume) {
    std::filesystem::remove_all(files.checkpoint(), none);
    return nullptr;
  }
  auto checkpoint = std::make_unique<RunCheckpoint>(files, RunBegun{whole.command, identityOf(options, setup), whole.beginnings}, seconds, resume);
  whole.command = checkpoint->command();
  if (resume && (!options.quiet || checkpoint->results().found().damaged > 0))
    std::cerr << "roomgraph: " << checkpoint->whatIsThere() << "\n";
  return checkpoint;
}

// A run is large, and a renderer needs memory, too: pages between those still in use are given back as well.
void release(std::unique_ptr<SemanticSlam>& slam) {
  slam.reset();
  giveBackFreedMemory();
}

Configuration configurationOf(const RunOptions& options) {
  Configuration out = readConfiguration(options.config, options.overrides);
  if (!options.calibration.empty()) useCalibration(out.config, options.calibration);
  for (const auto& pose : options.poses) placeSensor(out.config, pose);
  return out;
}

void printReasons(const RunBeginnings& beginnings, const ReplayState& replayed) {
  for (const std::string& reason : beginnings.reasons(replayed)) std::cerr << "roomgraph: " << reason << "\n";
}

// Stamps of images are what boxes that are kept apart from them are found by; poses that the user gave are right.
WhatStays whatStays(const RunOptions& options, const Configuration& configuration, const ReadOptions& reading) {
  const bool boxes_apart = !options.recording.empty() || !options.detections.empty() || !configuration.config.text("detection", "file", "").empty();
  return {.stamps_of_images = boxes_apart, .poses = !reading.sensor_poses.empty()};
}

void printEnd(const RunOptions& options, const OutputFolder& files, bool reported, bool drawn) {
  std::cout << "results in " << options.output;
  if (reported || drawn) std::cout << "; look at " << (files.folder() / (reported ? "report.html" : "snapshot.png")).string();
  std::cout << "\n";
}

// Returns whether the run is to begin anew.
bool runOnce(const RunOptions& options, WholeRun& whole) {
  Configuration configuration = configurationOf(options);
  auto [setup, networks, folder] = makeRunSetup(configuration, options.input, options.networks);
  ReadOptions reading = readOptionsOf(setup->options);
  const WhatStays stays = whatStays(options, configuration, reading);
  whole.beginnings.correct(reading, stays);
  RawlogReader reader(options.input, reading);
  if (const std::string advice = missingDetections(setup->stages, options.input); whole.beginnings.begun() == 1 && !advice.empty())
    std::cerr << "roomgraph: warning: " << advice << "\n";
  std::optional<CSemanticMap> earlier;
  if (!options.map.empty()) earlier = loadMap(options.map);
  const auto inputs = inputsOf(options, configuration);
  catchInterrupts();
  auto output = std::make_shared<RunOutput>(options.output, inputs);
  const auto checkpoint = openCheckpoint(options, *setup, output->files(), whole);
  RunPlaces places(options.input, output->files());
  const ExtraSinks extra = addSinks(options, *setup, reading);
  setup->options.general.lookahead_s += whole.beginnings.longestOffset();
  auto slam = std::make_unique<SemanticSlam>(std::move(setup));
  if (checkpoint) slam->setResultStore(checkpoint->results());
  if (earlier) slam->setMap(std::move(*earlier));
  slam->addSink(output);
  extra.addTo(*slam);

  const Stopwatch watch;
  if (!whole.examination && !options.no_report) whole.examination.emplace(options.input, reading.sensor_poses, options.span.until_s);
  bool again = false;
  const ReplayState replayed = replayWithProgress(options, reader, *slam, places, [&](const ReplayState& now) {
    return again = !interrupted() && whole.beginnings.shallBegin(*slam, reader, now, stays);
  });
  if (again || (!replayed.interrupted && whole.beginnings.shallBegin(*slam, reader, replayed, stays, true))) {
    printReasons(whole.beginnings, replayed);
    if (checkpoint) checkpoint->discard();
    return true;
  }
  // The whole run goes another way from here.
  if (checkpoint && replayed.interrupted) checkpoint->results().stop();
  SlamResult result = slam->finish();
  result.map.origin = std::filesystem::path(options.input).filename().string();
  requireRecords(options, slam->setup().options, replayed, result, checkpoint.get());
  RunOrigin origin = originOf(options, networks, checkpoint.get(), whole.beginnings, watch.seconds());
  if (whole.examination && !replayed.interrupted) origin.findings = findingsOf(whole, *slam, options.quiet);
  output->writeResult(*slam, result, reader.statistics(), replayed, origin);
  const ObjectDatabase database = slam->setup().database;
  const auto detector = slam->setup().stages.detector;  // the recordings know it
  release(slam);
  const bool drawn = !options.no_snapshot && drawSnapshot(result.map, database, output->files().pending("snapshot.png"));
  const auto page = output->files().pending("report.html");
  const bool reported = !options.no_report && writeRunReport(page.parent_path(), options.output, page);
  output->files().publish(checkpoint && replayed.interrupted);
  if (extra.recording) extra.recording->finish();
  if (extra.detections && !replayed.interrupted) extra.detections->finish();

  if (!networks.empty()) std::cout << "networks of " << folder.string() << ": " << join(networks) << "\n";
  std::cout << describeRun(result, replayed, reader.statistics(), watch.seconds());
  printWarnings(reader.statistics(), detector ? detector->warning() : "", origin.findings.value_or(std::vector<Finding>{}));
  printEnd(options, output->files(), reported, drawn);
  if (replayed.interrupted) throw Interrupted(whatWasReplayed(replayed, checkpoint.get(), options.output));
  return false;
}

void run(const RunOptions& options) {
  shareHeap();
  const ThreadLimit limit(options.threads);
  check(options);
  WholeRun whole;
  whole.resumes = !options.resume.empty();
  if (whole.resumes) whole.beginnings = beginningsOfCheckpoint(options.resume);
  while (runOnce(options, whole)) {
    whole.beginnings.again();
    giveBackFreedMemory();
  }
}

}  // namespace

void addRunCommand(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  auto* command = app.add_subcommand("run", "Replay a rawlog: trajectory, semantic map and picture");
  declareRunOptions(*command, *options);
  command->callback([options] {
    if (options->resume.empty()) {
      if (options->input.empty()) throw CLI::RequiredError("INPUT");
      if (options->output.empty()) throw CLI::RequiredError("--output");
      run(*options);
    } else if (const auto resumed = optionsToResume(*options)) {
      run(*resumed);
    }
  });
}

}  // namespace roomgraph
