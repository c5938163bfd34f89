// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph batch`: many recordings and variants, their catalogue, and the hidden command that carries one
// run out.
#include <unistd.h>

#include <iostream>
#include <memory>
#include <optional>

#include "batch_inspector.h"
#include "batch_tables.h"
#include "commands.h"
#include "interrupts.h"
#include "roomgraph/batch/batch.h"
#include "roomgraph/batch/run_task.h"
#include "roomgraph/core/checksum.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/rawlog_reader.h"

namespace roomgraph {
namespace {

struct BatchOptions {
  std::vector<std::string> inputs, overrides;
  std::string output, config, memory, time, keep, split, overlap, engine = "local";
  std::optional<int> jobs, threads, retries;
  bool dry_run = false, quiet = false;
};

bool isJobFile(const std::string& name) {
  return name.ends_with(".yaml") || name.ends_with(".yml");
}

template <class Read>
void readOption(const std::string& text, const char* option, Read read, double& value) {
  if (text.empty()) return;
  try {
    value = read(text);
  } catch (const std::invalid_argument& error) {
    throw ConfigError(std::string(option) + ": " + error.what());
  }
}

/// The job file, or jobs made of the recordings; options of the command line count more.
JobFile jobsOfOptions(const BatchOptions& options) {
  const bool file = options.inputs.size() == 1 && isJobFile(options.inputs.front());
  for (const auto& input : options.inputs)
    if (!file && isJobFile(input))
      throw ConfigError(input + ": a job file stands alone: name the recordings in it");
  JobFile jobs = file ? readJobFile(options.inputs.front()) : jobsOfRecordings(options.inputs);
  for (auto& variant : jobs.variants) {
    if (!options.config.empty() && variant.config.empty())
      variant.config = std::filesystem::absolute(options.config);
    variant.overrides.insert(variant.overrides.begin(), options.overrides.begin(), options.overrides.end());
  }
  jobs.limits.jobs = options.jobs.value_or(jobs.limits.jobs);
  jobs.limits.threads = options.threads.value_or(jobs.limits.threads);
  jobs.limits.retries = options.retries.value_or(jobs.limits.retries);
  if (options.engine == "slurm" && !options.threads && jobs.slurm.cpus > 0)
    jobs.limits.threads = jobs.slurm.cpus;
  readOption(options.memory, "--memory", megabytesOf, jobs.limits.memory_mb);
  readOption(options.time, "--time", secondsOf, jobs.limits.time_s);
  readOption(options.split, "--split", secondsOf, jobs.split.length_s);
  readOption(options.overlap, "--overlap", secondsOf, jobs.split.overlap_s);
  requireSensibleSplit(jobs.split);
  if (!options.keep.empty()) jobs.keep = keepFromText(options.keep);
  return jobs;
}

void tellOutcome(const BatchOutcome& outcome, const std::filesystem::path& folder) {
  char times[160];
  std::snprintf(times, sizeof times, "%.1f s; the runs took %.1f s one by one\n", outcome.wall_s,
                outcome.run_s);
  std::cout << outcome.done << " runs done, " << outcome.skipped << " unchanged, " << outcome.failed
            << " failed, " << outcome.left << " left; " << times << "catalogue in "
            << (folder / "catalogue.sqlite").string() << "; look at it with 'roomgraph batch status "
            << folder.string() << "'\n";
}

std::unique_ptr<Engine> engineOf(const BatchOptions& options, const JobFile& jobs,
                                 const SlurmPlaces& places) {
  if (options.engine == "slurm") return makeSlurmEngine(jobs, places, [] { return !interruptedByHand(); });
  if (hasSlurmTasks(places.folder))
    throw ConfigError((places.folder / "slurm").string() +
                      ": jobs of this batch are in a queue; '--engine slurm' goes on with them");
  return makeLocalEngine(jobs.limits);
}

void batch(const BatchOptions& options) {
  if (options.inputs.empty())
    throw ConfigError("batch needs a job file or recordings, or one of its commands (--help)");
  if (options.output.empty()) throw ConfigError("batch needs -o DIR, the folder of the batch");
  const std::filesystem::path folder = std::filesystem::absolute(options.output).lexically_normal();
  const BatchPlan plan = planBatch(jobsOfOptions(options), folder);
  ProgramInspector inspector;
  for (const auto& variant : plan.variants) inspector.check(variant);
  const BatchProgram program = thisProgram();
  const SlurmPlaces places{folder, program.file, program.parts};
  if (options.dry_run) {
    const PlanInWords words = describePlan(plan, folder, program, inspector);
    std::cout << words.text;
    if (options.engine == "slurm" && words.needed > 0)
      std::cout << "Script of an array of them:\n"
                << slurmScriptOf(plan.jobs, places, words.needed, words.memory_mb);
    return;
  }
  catchInterrupts();
  const BatchLock lock(folder);
  const auto engine = engineOf(options, plan.jobs, places);
  const BatchView view{options.quiet ? nullptr : &std::cerr, isatty(STDERR_FILENO) == 1};
  const BatchOutcome outcome = runBatch(plan, folder, program, inspector, *engine, view, interrupted, lock);
  tellOutcome(outcome, options.output);
  if (outcome.interrupted)
    throw Interrupted("interrupted: " + std::to_string(outcome.left) +
                      " runs left; the same command again goes on");
  if (outcome.failed > 0)
    throw RunError(std::to_string(outcome.failed) + " of " +
                   std::to_string(outcome.done + outcome.skipped + outcome.failed) +
                   " runs failed, the first: " + outcome.problems.front());
  if (!outcome.unevaluated.empty())
    throw RunError(std::to_string(outcome.unevaluated.size()) + " of " + std::to_string(outcome.done) +
                   " runs done could not be evaluated, the first: " + outcome.unevaluated.front());
}

// For the engines: not for people.
void addTaskCommand(CLI::App& app) {
  auto file = std::make_shared<std::string>();
  auto* command = app.add_subcommand("batch-task", "Carry out one run of a batch")->group("");
  command->add_option("TASK", *file, "task.json of the run")->required();
  command->callback([file] {
    catchInterrupts();
    const int exit_code =
        performRunTask(readRunTask(*file), std::filesystem::read_symlink("/proc/self/exe"), interrupted);
    if (exit_code == 4) throw Interrupted("interrupted");
    if (exit_code != 0) throw RunError("the run failed: see its result.json");
  });
}

// Stamps of the records; images are not decoded where there is anything else.
std::vector<double> stampsOf(const std::string& rawlog) {
  for (const bool frames : {false, true}) {
    ReadOptions kinds;
    kinds.frames = frames;
    RawlogReader reader(rawlog, kinds);
    std::vector<double> stamps;
    while (const auto record = reader.next()) {
      if (interrupted()) throw Interrupted("interrupted");
      stamps.push_back(timeOf(*record));
    }
    if (!stamps.empty()) return stamps;
  }
  return {};
}

// Reads all of a recording, for a batch: not for people.
void addMeasureCommand(CLI::App& app) {
  auto rawlog = std::make_shared<std::string>(), file = std::make_shared<std::string>();
  auto* command = app.add_subcommand("batch-measure", "Measure a recording")->group("");
  command->add_option("RAWLOG", *rawlog, "recording")->required();
  command->add_option("FILE", *file, "where its length and checksum are written")->required();
  command->callback([rawlog, file] {
    catchInterrupts();
    RecordingMeasure measure = measureOf(stampsOf(*rawlog));
    measure.sha256 = sha256OfFile(*rawlog);
    writeMeasure(*file, *rawlog, measure);
  });
}

// On a node of a cluster: not for people.
void addElementCommand(CLI::App& app) {
  auto folder = std::make_shared<std::string>();
  auto index = std::make_shared<std::size_t>(0);
  auto* command = app.add_subcommand("batch-element", "Carry out one task of an array job")->group("");
  command->add_option("ARRAY", *folder, "folder of the array")->required();
  command->add_option("INDEX", *index, "of the task")->required();
  command->callback([folder, index] {
    catchInterrupts();
    const int exit_code = performArrayTask(*folder, *index, interrupted);
    if (exit_code == 4) throw Interrupted("interrupted");
    if (exit_code != 0) throw RunError("the task failed (" + std::to_string(exit_code) + ")");
  });
}

void addLimits(CLI::App& command, BatchOptions& options) {
  command
      .add_option("--engine", options.engine,
                  "what carries the runs out: this machine, or array jobs of Slurm")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str();
  command.add_option("--jobs", options.jobs, "runs at once (default: cores / threads)")->check(atLeastZero());
  command.add_option("--threads", options.threads, "of each run (default 1)")->check(aboveZero());
  command.add_option("--memory", options.memory,
                     "of all runs together, like '8 GB' (default: what is available)");
  command.add_option("--time", options.time, "of one run at most, like '30 min' (default: no limit)");
  command.add_option("--retries", options.retries, "of a run that failed or was killed (default 0)")
      ->check(atLeastZero());
  command.add_option("--split", options.split,
                     "run recordings in pieces of about this length, like '600 s', and join them");
  command.add_option("--overlap", options.overlap,
                     "what a piece has in common with the one before it (default 20 s)");
  command
      .add_option("--keep", options.keep, "what a run leaves: its figures, also its map and report, or all")
      ->check(CLI::IsMember({"summary", "map", "all"}));
}

}  // namespace

void addBatchCommand(CLI::App& app) {
  auto options = std::make_shared<BatchOptions>();
  auto* command =
      app.add_subcommand("batch", "Run many recordings with many configurations, and compare what comes out");
  command->add_option("INPUT", options->inputs, "job file (.yaml), or rawlogs and patterns of them");
  command->add_option("-o,--output", options->output,
                      "folder of the batch: DIR/catalogue.sqlite, DIR/runs/NAME/");
  command->add_option("--config", options->config,
                      "configuration of variants that name none (default: the installed config.ini)");
  command->add_option("--set", options->overrides,
                      "override for every variant: section.key=value; may be repeated");
  addLimits(*command, *options);
  command->add_flag("--dry-run", options->dry_run, "say what would be done, and do nothing");
  command->add_flag("--quiet", options->quiet, "no progress");
  command->footer(
      "Examples:\n"
      "  roomgraph batch recordings/*.rawlog -o out/batch          # every recording once\n"
      "  roomgraph batch jobs.yaml -o out/batch --dry-run          # what would be done\n"
      "  roomgraph batch jobs.yaml -o out/batch --jobs 4 --keep map\n"
      "  roomgraph batch jobs.yaml -o /shared/batch --engine slurm # on a cluster; 'slurm:' in the job file\n"
      "  roomgraph batch status out/batch                          # how far, and the figures of each "
      "variant\n"
      "  roomgraph batch compare out/batch --baseline default\n"
      "  roomgraph batch report out/batch                          # out/batch/report.html\n"
      "  roomgraph batch query out/batch \"SELECT name, wall_s FROM runs ORDER BY wall_s DESC LIMIT 5\"\n"
      "  roomgraph batch export out/batch csv -o figures.csv\n"
      "A recording that has the name of one of these commands is written ./status.\n"
      "Job files: docs/batch.md. What is complete and unchanged is not done again: after Ctrl-C (exit code "
      "4), a crash or a "
      "change, the same command does what is left.");
  addBatchTables(*command);
  command->callback([options, command] {
    if (command->get_subcommands().empty()) batch(*options);
  });
  addTaskCommand(app);
  addElementCommand(app);
  addMeasureCommand(app);
}

}  // namespace roomgraph
