// SPDX-License-Identifier: BSD-3-Clause
// Order of a batch: inputs first, each run when its input and its detections are there.
#include "batch_at_work.h"

#include <csignal>
#include <thread>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/progress_file.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

constexpr auto kLookAround = std::chrono::milliseconds(20);
// A simulated recording is written as it comes; its renderer is what takes memory.
constexpr double kSimulation_mb = 400;

std::string oneDecimal(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

// The input, the configuration and a run that takes too long will be no better next time.
bool mayGoBetter(const RunResult& result) {
  return result.status == "failed" && (result.exit_code == 1 || result.exit_code > 128) &&
         !result.reason.starts_with("over its time limit");
}

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw RunError(folder.string() + ": cannot be made: " + error.message());
}

}  // namespace

BatchAtWork::BatchAtWork(const BatchPlan& plan, const fs::path& folder, const BatchProgram& program,
                         RunInspector& inspector, Engine& engine, const BatchView& view, Catalogue& catalogue)
    : plan_(plan),
      folder_(folder),
      program_(program),
      engine_(engine),
      catalogue_(catalogue),
      hashes_(&catalogue, &catalogue),
      preparer_(plan, folder, program, inspector, hashes_),
      forecast_(catalogue.pastCosts()),
      display_(view) {
  for (std::size_t run = 0; run < plan.runs.size(); ++run) waiting_.push_back(run);
}

void BatchAtWork::problem(const std::string& name, const std::string& reason) {
  outcome_.problems.push_back(name + ": " + reason);
  display_.event("failed    " + name + ": " + reason);
}

void BatchAtWork::record(const RunResult& result, const fs::path& folder) {
  catalogue_.import(result, stampOf(folder / "result.json"));
}

// What never ran has a result too: the catalogue knows it and why.
void BatchAtWork::failWithoutRun(std::size_t run, int exit_code, const std::string& reason) {
  RunResult result = preparer_.planned(run);
  result.status = "failed";
  result.reason = reason;
  result.exit_code = exit_code;
  result.started = timeStamp();
  result.keep = toText(plan_.jobs.keep);
  result.failures = failures_[run];
  result.failures.push_back({result.started, exit_code, reason, 0});
  const fs::path folder = preparer_.folderOf(run);
  makeFolder(folder);
  writeRunResult(result, folder / "result.json");
  record(result, folder);
  ++outcome_.failed;
  problem(result.name, reason);
}

BatchAtWork::Step BatchAtWork::tryInput(std::size_t input) {
  if (ready_inputs_.contains(input)) return Step::kOver;
  if (inputs_underway_.contains(input)) return Step::kWaits;
  if (preparer_.isReady(input)) {
    ready_inputs_.insert(input);
    return Step::kOver;
  }
  if (!engine_.accepts(kSimulation_mb)) return Step::kFull;
  preparer_.markReady(input, false);
  const fs::path folder = preparer_.folderOfInput(input);
  makeFolder(folder);
  EngineTask task{
      taskOfInput(input), {program_.file.string(), "simulate"}, folder.string() + ".log", kSimulation_mb};
  const auto& words = plan_.inputs[input].simulate;
  task.command.insert(task.command.end(), words.begin(), words.end());
  task.command.insert(task.command.end(), {"-o", folder.string(), "--quiet"});
  std::error_code none;
  fs::remove(task.log, none);
  engine_.start(task);
  inputs_underway_[input] = display_.elapsed();
  display_.event("simulate  " + plan_.inputs[input].input.name);
  return Step::kWaits;
}

BatchAtWork::Step BatchAtWork::tryRun(std::size_t run) {
  const std::size_t input = plan_.runs[run].input;
  if (const auto failed = failed_inputs_.find(input); failed != failed_inputs_.end()) {
    failWithoutRun(run, 1, failed->second);
    return Step::kOver;
  }
  if (const Step step = tryInput(input); step != Step::kOver) return step;
  try {
    if (!prepared_.contains(run)) prepared_[run] = preparer_.prepare(run);
  } catch (const Error& error) {
    failWithoutRun(run, error.exit_code, error.what());
    return Step::kOver;
  }
  PreparedRun& prepared = prepared_[run];
  if (!prepared.needed) {
    ++outcome_.skipped;
    return Step::kOver;
  }
  const bool share = !prepared.detections.empty() && prepared.task.run_again;
  if (share && recorders_.contains(prepared.detections.string())) return Step::kWaits;
  const auto& recording = prepared.task.planned.input;
  const double memory =
      forecast_.expected(recording.sha256, recording.bytes) * std::max(1.0, more_memory_[run]);
  if (!engine_.accepts(memory)) return Step::kFull;
  launch(run, std::move(prepared));
  prepared_.erase(run);
  return Step::kStarted;
}

void BatchAtWork::launch(std::size_t run, PreparedRun prepared) {
  preparer_.requireSameProgram();
  if (!prepared.detections.empty() && prepared.task.run_again) {
    const bool there = fs::exists(prepared.detections);
    if (!there) {
      makeFolder(prepared.detections.parent_path());
      recorders_[prepared.detections.string()] = run;
    }
    RunPreparer::shareDetections(prepared, there);
  }
  auto& earlier = failures_[run];
  prepared.task.planned.failures.insert(prepared.task.planned.failures.end(), earlier.begin(), earlier.end());
  makeFolder(prepared.task.folder);
  const fs::path file = prepared.task.folder / "task.json";
  std::error_code none;
  fs::remove(prepared.task.folder / "result.json", none);
  writeRunTask(prepared.task, file);
  const auto& recording = prepared.task.planned.input;
  const double memory =
      forecast_.expected(recording.sha256, recording.bytes) * std::max(1.0, more_memory_[run]);
  engine_.start({run,
                 {program_.file.string(), "batch-task", file.string()},
                 prepared.task.folder / "task.log",
                 memory});
  display_.event(std::string(prepared.task.run_again ? "start     " : "evaluate  ") +
                 prepared.task.planned.name + " (" + prepared.why + ")");
  underway_[run] = {std::move(prepared), display_.elapsed()};
}

void BatchAtWork::startAll() {
  for (std::size_t left = waiting_.size(); left > 0; --left) {
    const std::size_t run = waiting_.front();
    const Step step = tryRun(run);
    if (step == Step::kFull) return;  // first come, first served: nobody overtakes who waits for memory
    waiting_.pop_front();
    if (step == Step::kWaits) waiting_.push_back(run);
  }
}

void BatchAtWork::takeInInput(std::size_t input, int exit_code) {
  inputs_underway_.erase(input);
  const std::string& name = plan_.inputs[input].input.name;
  if (exit_code == 0) {
    preparer_.markReady(input, true);
    ready_inputs_.insert(input);
    display_.event("simulated " + name);
  } else if (!outcome_.interrupted) {
    failed_inputs_[input] = "its input " + name + " could not be simulated (exit code " +
                            std::to_string(exit_code) + "): see " + preparer_.folderOfInput(input).string() +
                            ".log";
  }
}

bool BatchAtWork::tryAgain(std::size_t run, const RunResult& result) {
  const auto attempts = failures_[run].size();
  if (outcome_.interrupted || !mayGoBetter(result) ||
      attempts > static_cast<std::size_t>(plan_.jobs.limits.retries))
    return false;
  if (result.exit_code == 128 + SIGKILL) more_memory_[run] = 2 * std::max(1.0, more_memory_[run]);
  waiting_.push_back(run);
  display_.event("again     " + result.name + ": " + result.reason);
  return true;
}

void BatchAtWork::takeInRun(std::size_t run, int exit_code) {
  Underway under = std::move(underway_.at(run));
  underway_.erase(run);
  std::erase_if(recorders_, [run](const auto& recorder) { return recorder.second == run; });
  const fs::path& folder = under.run.task.folder;
  std::error_code none;
  auto result = resultIn(folder);
  if (!result) {  // the process that carries the task out was killed itself
    result = under.run.task.planned;
    result->status = outcome_.interrupted ? "interrupted" : "failed";
    result->exit_code = exit_code;
    result->reason = exit_code > 128 ? "ended by signal " + std::to_string(exit_code - 128)
                                     : "no result; see " + (folder / "task.log").string();
    result->wall_s = display_.elapsed() - under.started_s;
    if (!outcome_.interrupted)
      result->failures.push_back({timeStamp(), exit_code, result->reason, result->wall_s});
    writeRunResult(*result, folder / "result.json");
  } else {
    fs::remove(folder / "task.log", none);
  }
  failures_[run] = result->failures;
  record(*result, folder);
  if (result->complete()) {
    ++outcome_.done;
    outcome_.run_s += display_.elapsed() - under.started_s;
    forecast_.add({result->input.sha256, result->input.bytes, result->peak_memory_mb, result->wall_s});
    display_.event("complete  " + result->name + ": " + oneDecimal(result->wall_s) + " s, " +
                   oneDecimal(result->peak_memory_mb) + " MB" +
                   (result->reason.empty() ? "" : "; warning: " + result->reason));
    if (!result->reason.empty()) outcome_.problems.push_back(result->name + ": " + result->reason);
  } else if (result->status == "interrupted") {
    ++outcome_.left;
  } else if (!tryAgain(run, *result)) {
    ++outcome_.failed;
    problem(result->name, result->reason);
  }
}

void BatchAtWork::takeIn(const EndedTask& ended) {
  if (ended.id >= plan_.runs.size())
    takeInInput(ended.id - plan_.runs.size(), ended.exit_code);
  else
    takeInRun(ended.id, ended.exit_code);
}

void BatchAtWork::draw() {
  std::vector<ShownTask> running;
  for (const auto& [input, started] : inputs_underway_)
    running.push_back({plan_.inputs[input].input.name + " (simulated)", -1, display_.elapsed() - started});
  for (const auto& [run, under] : underway_)
    running.push_back({under.run.task.planned.name,
                       readProgress(under.run.task.folder / "progress").value_or(0),
                       display_.elapsed() - under.started_s});
  display_.draw({outcome_.done, outcome_.failed, outcome_.skipped, plan_.runs.size()}, running);
}

BatchOutcome BatchAtWork::work(const std::function<bool()>& interrupted) {
  while (!waiting_.empty() || !underway_.empty() || !inputs_underway_.empty()) {
    if (!outcome_.interrupted && interrupted()) {
      outcome_.interrupted = true;
      display_.event("interrupted: what runs is told to end; once more kills it");
      engine_.interrupt();
    }
    if (!outcome_.interrupted) startAll();
    if (outcome_.interrupted && underway_.empty() && inputs_underway_.empty()) break;
    for (const auto& ended : engine_.ended()) takeIn(ended);
    draw();
    std::this_thread::sleep_for(kLookAround);
  }
  outcome_.left += waiting_.size();
  outcome_.wall_s = display_.elapsed();
  return outcome_;
}

}  // namespace roomgraph
