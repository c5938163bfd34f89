// SPDX-License-Identifier: BSD-3-Clause
// What came of a run: its result, another attempt, the catalogue.
#include "batch_at_work.h"

#include <csignal>

#include "roomgraph/core/errors.h"
#include "task_array.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

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
  if (const auto before = resultIn(preparer_.folderOf(run)); before && before->complete()) {
    // Hours of work, which may be as good as ever when the recording can be read again.
    ++outcome_.failed;
    over_[run] = reason;
    problem(result.name, reason + "; what it had found before stays");
    return;
  }
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
  over_[run] = reason;
  problem(result.name, reason);
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

// What the run says of itself, and what it cannot say: that it was killed, ended by others, or begun more
// than once.
RunResult BatchAtWork::resultOf(const Underway& under, const EndedTask& ended) {
  const fs::path& folder = under.run.task.folder;
  auto result = resultIn(folder);
  const bool told = result.has_value();
  if (!told) {  // the process that carries the task out was killed itself
    result = under.run.task.planned;
    result->status = "failed";
    result->exit_code = ended.exit_code;
    result->reason = !ended.reason.empty()   ? ended.reason
                     : ended.exit_code > 128 ? "ended by signal " + std::to_string(ended.exit_code - 128)
                                             : "no result; see " + (folder / "task.log").string();
    result->wall_s = display_.elapsed() - under.started_s;
  } else {
    std::error_code none;
    fs::remove(folder / "task.log", none);
  }
  const bool ended_by_others = told && result->status == "interrupted" && !outcome_.interrupted;
  if (ended_by_others) {
    result->status = "failed";
    result->exit_code = ended.exit_code > 128 ? ended.exit_code : 128 + SIGTERM;
    result->reason = ended.reason.empty() ? "told to end, not by this batch" : ended.reason;
  }
  auto& failures = result->failures;
  failures.insert(failures.end(), ended.lost.begin(), ended.lost.end());
  if (result->status == "failed" && (!told || ended_by_others))
    failures.push_back({timeStamp(), result->exit_code, result->reason, result->wall_s});
  if (!told || ended_by_others || !ended.lost.empty()) writeRunResult(*result, folder / "result.json");
  return *result;
}

void BatchAtWork::takeInRun(std::size_t run, const EndedTask& ended) {
  const Underway under = std::move(underway_.at(run));
  underway_.erase(run);
  std::erase_if(recorders_, [run](const auto& recorder) { return recorder.second == run; });
  if (ended.goes_on || (outcome_.interrupted && !resultIn(under.run.task.folder))) {
    ++outcome_.left;
    return;
  }
  if (under.outdated && !outcome_.interrupted) {
    waiting_.push_back(run);
    return;
  }
  const RunResult result = resultOf(under, ended);
  failures_[run] = result.failures;
  record(result, under.run.task.folder);
  if (result.complete() && outcome_.interrupted && ended.exit_code == kInterrupted) {
    ++outcome_.left;  // whole, but not evaluated
  } else if (result.complete()) {
    ++outcome_.done;
    over_[run] = "";
    outcome_.run_s += display_.elapsed() - under.started_s;
    forecast_.add({result.input.sha256, result.input.bytes, result.peak_memory_mb, result.wall_s});
    display_.event("complete  " + result.name + ": " + oneDecimal(result.wall_s) + " s, " +
                   oneDecimal(result.peak_memory_mb) + " MB" +
                   (result.reason.empty() ? "" : "; warning: " + result.reason));
    if (!result.reason.empty()) outcome_.unevaluated.push_back(result.name + ": " + result.reason);
  } else if (result.status == "interrupted") {
    ++outcome_.left;
  } else if (!tryAgain(run, result)) {
    ++outcome_.failed;
    over_[run] = result.reason;
    problem(result.name, result.reason);
  }
}

void BatchAtWork::takeIn(const EndedTask& ended) {
  if (ended.id < plan_.inputs.size())
    takeInInput(ended.id, ended);
  else
    takeInRun(ended.id - plan_.inputs.size(), ended);
}

}  // namespace roomgraph
