// SPDX-License-Identifier: BSD-3-Clause
// What becomes of the jobs of a Slurm engine: answers of sbatch and squeue, and files that nodes leave.
#include <algorithm>

#include "preparation.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "slurm_engine.h"
#include "task_array.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;
using Seconds = std::chrono::duration<double>;

constexpr double kSilence_s = 120;  // of a command of Slurm, before it is ended
constexpr double kAccountingLimit_s = 10, kCancelLimit_s = 60;
constexpr double kRequeue_s = 3;  // for which a job that is requeued may be in no state of a queue
constexpr double kPollAtTheEnd_s = 1;  // when somebody waits for jobs to be cancelled
constexpr std::size_t kCancelledAtOnce = 200;

// "17" or "17;cluster" among whatever else sbatch said.
std::string jobIn(const std::string& answer) {
  std::istringstream lines(answer);
  for (std::string line; std::getline(lines, line);) {
    const std::string job = line.substr(0, line.find(';'));
    if (!job.empty() && job.find_first_not_of("0123456789") == std::string::npos) return job;
  }
  return "";
}

std::string lastWordsIn(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return lastLineOf(text.str());
}

}  // namespace

void SlurmEngine::pollSubmission() {
  if (!submission_) return;
  // It would try again by itself for minutes; this engine has other things to do meanwhile.
  const bool sleeps = submission_->answer().find("sleeping and retrying") != std::string::npos;
  const bool silent = Seconds(Clock::now() - submission_->started()).count() > kSilence_s;
  if (sleeps || silent) submission_->stop();
  const auto end = submission_->ended();
  if (!end) return;
  const std::string answer = submission_->answer();
  submission_.reset();
  Array& array = arrays_.at(submitted_array_);
  array.job = *end == 0 ? jobIn(answer) : silent ? jobOfName(array.tasks.name) : "";
  if (array.job.empty()) return refused(array, answer);
  writeFileAtomically(array.folder / "job", array.job + "\n");
  array.submitted = Clock::now();
  for (std::size_t i = 0; i < submitted_tasks_.size(); ++i) {
    array.elements[i].id = submitted_tasks_[i].id;
    places_of_[submitted_tasks_[i].id] = {submitted_array_, i};
  }
  news_.push_back("submitted job " + array.job + ": " + std::to_string(submitted_tasks_.size()) + " tasks");
  submitted_tasks_.clear();
  full_ = false;
  largest_array_ = std::min(kLargestArray, 2 * largest_array_);
}

// A queue that takes no thousand may take five hundred; one that takes none is asked again later.
void SlurmEngine::refused(Array& array, const std::string& answer) {
  std::error_code none;
  fs::remove(array.folder / "tasks.json", none);
  fs::remove_all(array.folder, none);
  arrays_.erase(submitted_array_);
  const std::size_t count = submitted_tasks_.size();
  waiting_.insert(waiting_.begin(), submitted_tasks_.begin(), submitted_tasks_.end());
  submitted_tasks_.clear();
  const std::string words = lastLineOf(answer);
  if (!answer.empty() && !isRefusedForNow(answer)) throw RunError("sbatch refuses: " + words);
  largest_array_ = std::max<std::size_t>(1, count / 2);
  if (count > 1) return;
  not_before_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(Seconds(jobs_.slurm.poll_s));
  if (!full_)
    news_.push_back("waits     the queue takes no more now (" + words +
                    "): " + std::to_string(waiting_.size()) + " tasks to be submitted");
  full_ = true;
}

void SlurmEngine::pollQueue() {
  const auto now = Clock::now();
  if (!question_) {
    const bool asked_for =
        std::any_of(arrays_.begin(), arrays_.end(), [](const auto& a) { return !a.second.job.empty(); });
    if (asked_for && now >= next_question_) question_.emplace(queueQuestion(), answerFile("queue"));
    return;
  }
  const auto end = question_->ended();
  if (!end) {
    if (Seconds(now - question_->started()).count() > kSilence_s) question_->stop();
    return;
  }
  if (*end == 0)
    takeIn(queueOf(question_->answer()), question_->started());
  else if (!queue_silent_)
    news_.push_back("waits     squeue: " + question_->lastWords());
  queue_silent_ = *end != 0;
  question_.reset();
  const double pause = interrupted_ ? std::min(kPollAtTheEnd_s, jobs_.slurm.poll_s) : jobs_.slurm.poll_s;
  next_question_ = now + std::chrono::duration_cast<Clock::duration>(Seconds(pause));
}

void SlurmEngine::takeIn(const SlurmQueue& queue, Clock::time_point asked) {
  for (auto& [number, array] : arrays_) {
    if (array.job.empty() || array.submitted > asked) continue;
    std::error_code none;
    fs::directory_iterator(array.folder,
                           none);  // so that a network file system shows what nodes have written
    const auto first = queue.lower_bound({array.job, 0});
    const bool known_job = first != queue.end() && first->first.first == array.job;
    for (std::size_t i = 0; i < array.elements.size(); ++i)
      if (!array.elements[i].over) look(array, i, queue, known_job);
  }
}

// Files of a shared folder may come later than the word of the queue: what left the queue without a word is
// waited for, but for a job that was cancelled before it began.
void SlurmEngine::look(Array& array, std::size_t index, const SlurmQueue& queue, bool known_job) {
  Element& element = array.elements[index];
  const auto queued = queue.find({array.job, index});
  if (queued != queue.end()) element.state = queued->second.state;
  if (queued != queue.end() && isActive(element.state)) {
    element.left_at.reset();
    return;
  }
  // A task that is cancelled while it waits leaves no trace in a queue that knows the rest of its array.
  if (queued == queue.end() && isActive(element.state))
    element.state = known_job && !hasBegun(array.folder, index) ? "CANCELLED" : "";
  if (!element.left_at) element.left_at = Clock::now();
  const double waited_s = Seconds(Clock::now() - *element.left_at).count();
  if (auto end = readTaskEnd(array.folder, index)) {
    // Told to end, and not by this batch: the queue may be about to begin it again.
    if (end->exit_code == kInterrupted && !interrupted_ && waited_s < kRequeue_s) return;
    const QueueEnd known = endOfState(element.state);
    if (end->exit_code != 0 && end->reason.empty() && known.by_queue) *end = {known.exit_code, known.reason};
    return over(array, index, *end);
  }
  const bool begun = hasBegun(array.folder, index);
  if ((begun || element.state != "CANCELLED") && waited_s < jobs_.slurm.patience_s) return;
  if (element.state.empty()) element.state = stateInAccounting(array.job, index);
  QueueEnd end = endOfState(element.state);
  const std::string said = lastWordsIn(array.folder / (std::to_string(index) + ".out"));
  if (!end.by_queue && queued != queue.end()) end.reason += " (" + queued->second.reason + ")";
  if (!end.by_queue && !said.empty()) end.reason += ": " + said;
  // From here on a node that is alive all the same, or comes back, ends this task by itself.
  writeTaskEnd(array.folder, index, {end.exit_code, end.reason});
  over(array, index, {end.exit_code, end.reason});
}

void SlurmEngine::over(Array& array, std::size_t index, const TaskEnd& end) {
  Element& element = array.elements[index];
  element.over = true;
  if (!element.id) return;
  element.told = true;
  ended_.push_back({*element.id, end.exit_code, end.reason, false, lostStarts(array.folder, index)});
  places_of_.erase(*element.id);
}

void SlurmEngine::scancel(std::vector<std::string> jobs) {
  while (!jobs.empty()) {
    std::vector<std::string> words{"scancel", "--quiet"};
    for (std::size_t i = 0; i < kCancelledAtOnce && !jobs.empty(); ++i) {
      words.push_back(jobs.back());
      jobs.pop_back();
    }
    ToolCall call(words, answerFile("scancel"));
    if (ToolCall::wait(call, kCancelLimit_s) != 0) news_.push_back("waits     scancel: " + call.lastWords());
  }
}

// Of what the queue has forgotten; empty where there is no accounting.
std::string SlurmEngine::stateInAccounting(const std::string& job, std::size_t index) {
  if (no_accounting_) return "";
  try {
    ToolCall call({"sacct", "--noheader", "--parsable2", "--allocations", "--format=State", "--jobs",
                   job + "_" + std::to_string(index)},
                  answerFile("sacct"));
    no_accounting_ = ToolCall::wait(call, kAccountingLimit_s) != 0;
    const std::string state = call.lastWords();  // "CANCELLED by 1000"
    return no_accounting_ ? "" : state.substr(0, state.find(' '));
  } catch (const ConfigError&) {
    no_accounting_ = true;
    return "";
  }
}

}  // namespace roomgraph
