// SPDX-License-Identifier: BSD-3-Clause
// Order of a batch: inputs first, each run when its input and its detections are there.
#include "batch_at_work.h"

#include <algorithm>
#include <thread>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/progress_file.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

constexpr auto kLookAround = std::chrono::milliseconds(20);

}  // namespace

BatchAtWork::BatchAtWork(const BatchPlan& plan, const fs::path& folder, const BatchProgram& program,
                         RunInspector& inspector, Engine& engine, const BatchView& view, Catalogue& catalogue)
    : plan_(plan),
      folder_(folder),
      program_(program),
      engine_(engine),
      catalogue_(catalogue),
      hashes_(&catalogue, &catalogue),
      preparer_(plan_, folder, program, inspector, hashes_),
      forecast_(catalogue.pastCosts()),
      display_(view) {
  for (std::size_t run = 0; run < plan.runs.size(); ++run) waiting_.push_back(run);
  // What is under way already comes first: it may be computing detections that others wait for.
  std::stable_partition(waiting_.begin(), waiting_.end(),
                        [this](std::size_t run) { return engine_.remembers(commandOf(run)); });
}

std::vector<std::string> BatchAtWork::commandOf(std::size_t run) const {
  return {program_.file.string(), "batch-task", (preparer_.folderOf(run) / "task.json").string()};
}

BatchAtWork::Step BatchAtWork::tryRun(std::size_t run) {
  const std::size_t input = plan_.runs[run].input;
  if (const auto failed = failed_inputs_.find(input); failed != failed_inputs_.end()) {
    failWithoutRun(run, 1, failed->second);
    return Step::kOver;
  }
  if (const Step step = tryInput(input); step != Step::kOver) return step;
  if (plan_.jobs.split.length_s > 0 && !plan_.runs[run].span && !split_.contains(run)) split(run);
  if (waitsForPieces(run)) return Step::kWaits;
  for (const auto piece : plan_.runs[run].pieces)
    if (const std::string& reason = over_.at(piece); !reason.empty()) {
      failWithoutRun(run, 1, "its piece " + plan_.runs[piece].name + " failed: " + reason);
      return Step::kOver;
    }
  try {
    if (!prepared_.contains(run)) prepared_[run] = preparer_.prepare(run);
  } catch (const Error& error) {
    failWithoutRun(run, error.exit_code, error.what());
    return Step::kOver;
  }
  PreparedRun& prepared = prepared_[run];
  if (!prepared.needed) {
    ++outcome_.skipped;
    over_[run] = "";
    return Step::kOver;
  }
  if (engine_.remembers(commandOf(run))) {
    takeUp(run);
    return Step::kStarted;
  }
  const bool share = !prepared.detections.empty() && prepared.task.run_again;
  if (share && recorders_.contains(prepared.detections.string())) return Step::kWaits;
  if (!engine_.accepts(memoryOf(run, prepared.task.planned.input))) return Step::kFull;
  launch(run, std::move(prepared));
  prepared_.erase(run);
  return Step::kStarted;
}

double BatchAtWork::memoryOf(std::size_t run, const RunInput& recording) {
  return forecast_.expected(recording.sha256, recording.bytes) * std::max(1.0, more_memory_[run]);
}

// A run that a batch before this one started, and that the engine still knows. When it would be started
// otherwise now, it is ended and waited for: two are not to write into one folder.
void BatchAtWork::takeUp(std::size_t run) {
  PreparedRun now = std::move(prepared_.at(run));
  prepared_.erase(run);
  Underway under{now, display_.elapsed(), true};
  try {
    RunTask before = readRunTask(now.task.folder / "task.json");
    const RunResult &was = before.planned, &is = now.task.planned;
    under.outdated = was.key != is.key || was.evaluation_key != is.evaluation_key ||
                     before.keep != now.task.keep || before.run_again != now.task.run_again;
    const bool records =
        std::find(before.run.begin(), before.run.end(), "--save-detections") != before.run.end();
    if (!under.outdated && records) recorders_[now.detections.string()] = run;
    failures_[run] = was.failures;
    under.run.task = std::move(before);
  } catch (const InputError&) {  // it has ended meanwhile
  }
  engine_.takeUp(taskOfRun(run), commandOf(run));
  if (under.outdated) engine_.cancel(taskOfRun(run));
  display_.event((under.outdated ? "cancel    " : "found     ") + under.run.task.planned.name +
                 (under.outdated ? " (it was started before something changed)" : " (started before)"));
  underway_[run] = std::move(under);
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
  std::error_code none;
  if (prepared.task.run_again)
    fs::remove(prepared.task.folder / "result.json", none);
  else
    writeRunResult(withoutEvaluation(prepared.task), prepared.task.folder / "result.json");
  writeRunTask(prepared.task, prepared.task.folder / "task.json");
  engine_.start({taskOfRun(run), commandOf(run), prepared.task.folder / "task.log",
                 memoryOf(run, prepared.task.planned.input), std::max(1.0, more_memory_[run])});
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

void BatchAtWork::draw() {
  if (!display_.isDue()) return;
  constexpr std::size_t kShown =
      20;  // of hundreds on a cluster nobody reads more, and each costs a look at a file
  std::vector<ShownTask> running;
  ShownTotals totals{outcome_.done, outcome_.failed, outcome_.skipped, plan_.runs.size()};
  const auto show = [&](std::size_t id, double started_s, const auto& nameAndShare) {
    if (engine_.isQueued(id)) {
      ++totals.queued;
      return;
    }
    ++totals.running;
    if (running.size() >= kShown) return;
    const auto [name, share] = nameAndShare();
    running.push_back({name, share, display_.elapsed() - started_s});
  };
  for (const auto& [input, started] : inputs_underway_)
    show(input, started,
         [&, i = input] { return std::pair(plan_.inputs[i].input.name + " (simulated)", -1.0); });
  for (const auto& [run, under] : underway_)
    show(taskOfRun(run), under.started_s, [&task = under.run.task] {
      return std::pair(task.planned.name, readProgress(task.folder / "progress").value_or(0));
    });
  display_.draw(totals, running);
}

BatchOutcome BatchAtWork::work(const std::function<bool()>& interrupted) {
  while (!waiting_.empty() || !underway_.empty() || !inputs_underway_.empty()) {
    if (!outcome_.interrupted && interrupted()) {
      outcome_.interrupted = true;
      display_.event(engine_.interrupt());
    }
    if (!outcome_.interrupted) startAll();
    if (outcome_.interrupted && underway_.empty() && inputs_underway_.empty()) break;
    for (const auto& ended : engine_.ended()) takeIn(ended);
    for (const auto& line : engine_.news()) display_.event(line);
    draw();
    std::this_thread::sleep_for(kLookAround);
  }
  outcome_.left += waiting_.size();
  outcome_.wall_s = display_.elapsed();
  return outcome_;
}

}  // namespace roomgraph
