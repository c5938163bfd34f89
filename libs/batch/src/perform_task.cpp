// SPDX-License-Identifier: BSD-3-Clause
// The steps of a run as children of this process: replay, evaluations, result.
#include <csignal>
#include <fstream>
#include <thread>

#include "child_process.h"
#include "kept_files.h"
#include "roomgraph/batch/run_task.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kNotEvaluated = "its evaluation was not finished";
constexpr auto kLook = std::chrono::milliseconds(10);
// What is told to end writes its results first; whoever does not end in that time is stuck.
constexpr double kTimeToEnd_s = 20;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// How a step ended, and why this program ended it.
struct StepEnd {
  ChildEnd child;
  double wall_s = 0;
  bool timed_out = false, interrupted = false;
};

/// Waits for a child; one that is over its time or is to stop gets SIGINT, and SIGKILL when that does not
/// help.
StepEnd waitFor(ChildProcess& child, double limit_s, const std::function<bool()>& interrupted) {
  const auto start = Clock::now();
  std::optional<Clock::time_point> told;
  StepEnd end;
  for (;; std::this_thread::sleep_for(kLook)) {
    if (const auto child_end = child.ended()) {
      end.child = *child_end;
      end.wall_s = since(start);
      return end;
    }
    end.interrupted |= interrupted();
    end.timed_out |= !end.interrupted && limit_s > 0 && since(start) > limit_s;
    if (!told && (end.interrupted || end.timed_out)) {
      told = Clock::now();
      child.signal(SIGINT);
    }
    if (told && since(*told) > kTimeToEnd_s) child.signal(SIGKILL);
  }
}

// The last line that a step wrote into the log from `begin` on.
std::string lastLine(const fs::path& log, std::uintmax_t begin) {
  std::ifstream in(log, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(begin));
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  constexpr std::string_view kOurName = "roomgraph: ";
  return last.starts_with(kOurName) ? last.substr(kOurName.size()) : last;
}

std::uintmax_t sizeOf(const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  return error ? 0 : size;
}

std::string reasonOf(const StepEnd& end, double limit_s, const fs::path& log, std::uintmax_t begin) {
  if (end.interrupted) return "interrupted";
  if (end.timed_out)
    return "over its time limit of " + std::to_string(static_cast<long>(limit_s + 0.5)) + " s";
  if (end.child.exit_code == 128 + SIGKILL)
    return "killed (SIGKILL: by somebody, or by the system for want of memory)";
  if (end.child.exit_code > 128) return "ended by signal " + std::to_string(end.child.exit_code - 128);
  const std::string said = lastLine(log, begin);
  return said.empty() ? "exit code " + std::to_string(end.child.exit_code) : said;
}

/// One task as it goes on.
class Performance {
 public:
  Performance(const RunTask& task, fs::path program, const std::function<bool()>& interrupted)
      : task_(task),
        program_(std::move(program)),
        interrupted_(interrupted),
        log_(task.folder / "run.log"),
        result_(task.planned) {}

  int perform() {
    std::error_code none;
    if (task_.run_again) fs::remove(task_.folder / "result.json", none);  // from here on the folder holds no whole run
    if (task_.run_again) fs::remove(log_, none);
    if (task_.run_again) result_.started = timeStamp();
    result_.keep = toText(task_.keep);
    result_.command = task_.run;
    result_.status = "complete";
    result_.reason.clear();
    if (task_.run_again) replay();
    if (result_.complete()) evaluate();
    finish();
    return interrupted_here_ ? 4 : result_.complete() ? 0 : 1;
  }

 private:
  StepEnd step(const std::vector<std::string>& words, double limit_s) {
    std::vector<std::string> command{program_.string()};
    command.insert(command.end(), words.begin(), words.end());
    ChildProcess child(command, log_, false);
    return waitFor(child, limit_s, interrupted_);
  }

  // Goes on from the checkpoint of an attempt that was killed; one that cannot be gone on with (exit code 2
  // or 3: of another program, unreadable) is replaced.
  StepEnd runOrResume() {
    if (fs::exists(task_.folder / "roomgraph_checkpoint" / "run.json")) {
      std::vector<std::string> words = task_.run;
      words.insert(words.end(), {"--resume", task_.folder.string()});
      StepEnd end = step(words, task_.time_limit_s);
      if (end.child.exit_code != 2 && end.child.exit_code != 3) return end;
    }
    return step(task_.run, task_.time_limit_s);
  }

  void replay() {
    const auto begin = sizeOf(log_);
    const StepEnd end = runOrResume();
    result_.exit_code = end.child.exit_code;
    result_.wall_s = end.wall_s;
    result_.cpu_s = end.child.cpu_s;
    result_.peak_memory_mb = end.child.peak_memory_mb;
    // Who was told to end in the very last moment may have ended by itself.
    if (end.child.exit_code == 0) return;
    interrupted_here_ = end.interrupted;
    result_.status = end.interrupted ? "interrupted" : "failed";
    result_.reason = reasonOf(end, task_.time_limit_s, log_, begin);
    if (!end.interrupted)
      result_.failures.push_back({result_.started, result_.exit_code, result_.reason, result_.wall_s});
  }

  bool possible(const EvaluationStep& step) const {
    for (const auto& name : step.needs)
      if (sizeOf(task_.folder / name) == 0) return false;
    return true;
  }

  // An evaluation that fails or is interrupted does not make a run fail: it is told as the reason of what is missing.
  void evaluate() {
    result_.figures.clear();
    for (const auto& evaluation : task_.evaluations) {
      if (!possible(evaluation)) continue;
      const fs::path report = task_.folder / (evaluation.report + "_score.json");
      std::vector<std::string> words{"evaluate"};
      words.insert(words.end(), evaluation.arguments.begin(), evaluation.arguments.end());
      words.insert(words.end(), {"--json", report.string()});
      std::error_code none;
      fs::remove(report, none);
      const auto begin = sizeOf(log_);
      const StepEnd end = step(words, 0);
      if (end.interrupted) {
        result_.reason = kNotEvaluated;
        interrupted_here_ = true;
        break;
      }
      if (end.child.exit_code == 0)
        result_.figures.merge(numbersOf(report, evaluation.report));
      else
        result_.reason += (result_.reason.empty() ? "" : "; ") +
                          ("evaluate " + evaluation.report + ": " + reasonOf(end, 0, log_, begin));
    }
    addOwnFigures();
  }

  void addOwnFigures() {
    const fs::path summary = task_.folder / "summary.json";
    for (const auto& [name, value] : numbersOf(summary, "run"))
      if (name.starts_with("run.counts.")) result_.figures["counts." + name.substr(11)] = value;
    result_.figures["run.wall_s"] = result_.wall_s;
    result_.figures["run.cpu_s"] = result_.cpu_s;
    result_.figures["run.peak_memory_mb"] = result_.peak_memory_mb;
    result_.timings = stageTotalsOf(summary);
  }

  void finish() {
    std::error_code none;
    fs::remove(task_.folder / "progress", none);
    if (result_.complete() && result_.reason.empty()) removeUnkept(task_.folder, task_.keep);
    if (result_.complete() && !result_.reason.empty()) result_.keep = toText(Keep::kAll);  // to be evaluated the next time
    if (result_.complete()) fs::remove(task_.folder / "task.json", none);
    result_.files = filesIn(task_.folder);
    writeRunResult(result_, task_.folder / "result.json");
  }

  const RunTask& task_;
  fs::path program_;
  const std::function<bool()>& interrupted_;
  fs::path log_;
  RunResult result_;
  bool interrupted_here_ = false;
};

}  // namespace

RunResult withoutEvaluation(const RunTask& task) {
  RunResult out = task.planned;
  out.status = "complete";
  out.reason = kNotEvaluated;
  out.command = task.run;
  out.keep = toText(Keep::kAll);
  out.files = filesIn(task.folder);
  return out;
}

int performRunTask(const RunTask& task, const fs::path& program, const std::function<bool()>& interrupted) {
  return Performance(task, program, interrupted).perform();
}

}  // namespace roomgraph
