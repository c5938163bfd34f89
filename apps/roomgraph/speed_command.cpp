// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph bench speed`: a run without files, and how long each stage of it took.
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "bench_commands.h"
#include "commands.h"
#include "configuration.h"
#include "installed_networks.h"
#include "interrupts.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/progress.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/pipeline/read_options.h"
#include "roomgraph/pipeline/replay.h"
#include "roomgraph/pipeline/speed.h"
#include "run_report.h"
#include "shared_files.h"
#include "thread_limit.h"

namespace roomgraph {
namespace {

struct SpeedOptions {
  std::string input, config, json;
  std::vector<std::string> overrides;
  ModelSource networks;
  ReplaySpan span;
  int threads = 0;
  bool quiet = false;
};

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

rusage usedSoFar() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return used;
}

double processorTime_s(const rusage& used) {
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

SpeedReport measured(const SpeedOptions& options, RawlogReader& reader, SemanticSlam& slam) {
  const auto latency = std::make_shared<LatencySink>();
  slam.addSink(latency);
  SpeedReport report;
  const rusage before = usedSoFar();
  const auto start = Clock::now();
  Progress line(options.quiet ? nullptr : &std::cerr, "replay", "", 1);
  const auto show = [&](const ReplayState& now) {
    line.update(now.share, describeProgress(now, secondsSince(start)));
  };
  const ReplayState replayed = replay(reader, slam, options.span, {show, interrupted});
  line.finish();
  if (replayed.interrupted) throw Interrupted("a run that is cut short has no speed");
  if (replayed.records == 0) throw InputError(options.input + ": no record to replay");
  const auto last_record = Clock::now();
  slam.finish();
  report.end_s = secondsSince(last_record);
  report.wall_s = secondsSince(start);
  report.recorded_s = replayed.seconds();
  report.threads =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  report.stages = speedOfStages(slam.times());
  report.frames = latency->frames();
  report.scans = latency->scans();
  const rusage after = usedSoFar();
  report.cpu_s = processorTime_s(after) - processorTime_s(before);
  report.peak_memory_mb = static_cast<double>(after.ru_maxrss) / 1024;
  return report;
}

void benchSpeed(const SpeedOptions& options) {
  const ThreadLimit limit(options.threads);
  Configuration configuration = readConfiguration(options.config, options.overrides);
  auto [setup, networks, folder] = makeRunSetup(configuration, options.input, options.networks);
  RawlogReader reader(options.input, readOptionsOf(setup->options, configuration.config));
  if (!options.json.empty()) requireOther(options.json, {options.input, options.config});
  catchInterrupts();
  SemanticSlam slam(std::move(setup));
  const SpeedReport report = measured(options, reader, slam);
  std::cout << toTable(report);
  if (!options.json.empty()) writeFileAtomically(options.json, toJson(report));
}

}  // namespace

void addSpeedCommand(CLI::App& parent) {
  auto o = std::make_shared<SpeedOptions>();
  auto* command =
      parent.add_subcommand("speed", "Time per stage, latency, real-time factor and memory of a run");
  command->add_option("INPUT", o->input, "rawlog, plain or gzipped")->required();
  command->add_option("--config", o->config, "configuration (default: the installed config.ini)");
  command->add_option("--set", o->overrides, "override: section.key=value; may be repeated");
  command->add_option("--threads", o->threads, "upper limit of threads; 0: all cores")->check(atLeastZero());
  command->add_option("--from", o->span.from_s, "start this many seconds after the first record")
      ->check(atLeastZero());
  command->add_option("--until", o->span.until_s, "stop this many seconds after the first record; 0: the end")
      ->check(atLeastZero());
  command->add_option("--json", o->json, "Write the figures here, too");
  command->add_flag("--quiet", o->quiet, "no progress");
  command->footer(
      "Example:\n"
      "  roomgraph bench speed lab_a/lab_a.rawlog --set detection.rate_hz=5 --json speed.json\n"
      "Nothing is written but the JSON. Times are those of this machine now: compare two programs in turn.");
  command->callback([o] { benchSpeed(*o); });
}

}  // namespace roomgraph
