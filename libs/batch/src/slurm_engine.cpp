// SPDX-License-Identifier: BSD-3-Clause
// Tasks to array jobs, and what an earlier engine submitted.
#include "slurm_engine.h"

#include <algorithm>

#include "roomgraph/core/checksum.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/text_file.h"
#include "slurm_script.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

constexpr auto kGather = std::chrono::milliseconds(300);
constexpr double kAnswerLimit_s = 30;

std::string joined(const std::vector<std::string>& command) {
  std::string out;
  for (const auto& word : command) out += word + '\0';
  return out;
}

std::vector<fs::path> arrayFolders(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder / "slurm", none))
    if (fs::exists(entry.path() / "tasks.json", none)) out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

// The file of tasks goes first: a job that turns up later all the same finds nothing to do.
void removeArray(const fs::path& folder) {
  std::error_code none;
  fs::remove(folder / "tasks.json", none);
  fs::remove_all(folder, none);
}

fs::path folderOfArray(const fs::path& folder, std::size_t number) {
  char name[24];
  std::snprintf(name, sizeof name, "%06zu", number);
  return folder / "slurm" / name;
}

}  // namespace

SlurmEngine::SlurmEngine(const JobFile& jobs, SlurmPlaces places, std::function<bool()> leaves_jobs)
    : jobs_(jobs),
      places_(std::move(places)),
      leaves_jobs_(std::move(leaves_jobs)),
      program_(coarseStamps(places_.parts)),
      largest_array_(kLargestArray) {
  for (const char* command : {"sbatch", "squeue", "scancel"}) fileOfCommand(command);
  for (const auto& folder : arrayFolders(places_.folder)) recallArray(folder);
}

SlurmEngine::~SlurmEngine() {
  for (const auto& [number, array] : arrays_)
    if (std::all_of(array.elements.begin(), array.elements.end(), [](const auto& e) { return e.over; }))
      removeArray(array.folder);
}

std::string SlurmEngine::jobOfName(const std::string& name) {
  ToolCall call({"squeue", "--noheader", "--states=all", "--name=" + name, "--format=%F"},
                answerFile("name"));
  if (ToolCall::wait(call, kAnswerLimit_s) != 0)
    throw RunError("squeue: " + call.lastWords() + "; whether " + name +
                   " was submitted cannot be known now");
  return call.lastWords();
}

// A batch may have been killed before it read what sbatch answered: then the queue knows the job by its name.
void SlurmEngine::recallArray(const fs::path& folder) {
  Array array{folder, readTaskArray(folder), "", Clock::now(), {}};
  const bool known = fs::exists(folder / "job");
  array.job = known ? lastLineOf(readTextFile(folder / "job")) : jobOfName(array.tasks.name);
  array.elements.resize(array.tasks.tasks.size());
  bool begun = known;
  for (std::size_t i = 0; i < array.elements.size(); ++i) begun |= hasBegun(folder, i);
  if (array.job.empty() && !begun) {
    removeArray(folder);
    return;
  }
  if (!known && !array.job.empty()) writeFileAtomically(folder / "job", array.job + "\n");
  if (array.job.empty()) array.job = "forgotten";  // by the queue, which keeps what is over for minutes only
  const std::size_t number = std::stoul("0" + folder.filename().string());
  next_array_ = std::max(next_array_, number + 1);
  for (std::size_t i = 0; i < array.elements.size(); ++i) {
    remembered_[joined(array.tasks.tasks[i].command)] = {number, i};
    array.elements[i].over = readTaskEnd(folder, i).has_value();
  }
  arrays_[number] = std::move(array);
}

bool SlurmEngine::remembers(const std::vector<std::string>& command) const {
  return remembered_.contains(joined(command));
}

void SlurmEngine::takeUp(std::size_t id, const std::vector<std::string>& command) {
  const auto known = remembered_.find(joined(command));
  if (known == remembered_.end()) throw RunError("nothing is known of " + command.back());
  const ElementPlace place = known->second;
  remembered_.erase(known);
  Array& array = arrays_.at(place.array);
  array.elements[place.index].id = id;
  places_of_[id] = place;
  if (const auto end = readTaskEnd(array.folder, place.index)) over(array, place.index, *end);
}

bool SlurmEngine::accepts(double) {
  return jobs_.limits.jobs <= 0 || waiting_.size() + submitted_tasks_.size() + places_of_.size() <
                                       static_cast<std::size_t>(jobs_.limits.jobs);
}

void SlurmEngine::start(const EngineTask& task) {
  waiting_.push_back(task);
  last_start_ = Clock::now();
}

bool SlurmEngine::isQueued(std::size_t id) const {
  const auto place = places_of_.find(id);
  if (place == places_of_.end()) return true;
  const std::string& state = arrays_.at(place->second.array).elements[place->second.index].state;
  return state == "PENDING" || state == "CONFIGURING" || state.starts_with("REQUEUE");
}

// Those at the front of the queue that ask for the same memory, as many as an array may have.
std::vector<EngineTask> SlurmEngine::nextTasks(double memory_mb) {
  std::vector<EngineTask> out;
  std::deque<EngineTask> others;
  for (auto& task : waiting_) {
    const bool fits = out.size() < largest_array_ && memoryOf(task) == memory_mb;
    if (fits)
      out.push_back(std::move(task));
    else
      others.push_back(std::move(task));
  }
  waiting_.swap(others);
  return out;
}

double SlurmEngine::memoryOf(const EngineTask& task) const {
  return requestedMemory(jobs_.slurm, task.expected_memory_mb, task.memory_factor);
}

void SlurmEngine::submitNext() {
  const auto now = Clock::now();
  const bool more_may_come = now - last_start_ < kGather && waiting_.size() < largest_array_;
  if (submission_ || waiting_.empty() || now < not_before_ || more_may_come) return;
  const double memory_mb = memoryOf(waiting_.front());
  submitted_tasks_ = nextTasks(memory_mb);
  const std::size_t number = next_array_++;
  Array array{folderOfArray(places_.folder, number), {}, "", {}, {}};
  const std::string id = sha256Of(array.folder.string() + std::to_string(now.time_since_epoch().count()));
  array.tasks = {
      "roomgraph-" + std::to_string(number) + "-" + id.substr(0, 8), {}, jobs_.limits.retries + 1, program_};
  for (const auto& task : submitted_tasks_) array.tasks.tasks.push_back({task.command, task.log});
  array.elements.resize(submitted_tasks_.size());
  std::error_code error;
  fs::create_directories(array.folder, error);
  const fs::path script = array.folder / "job.sh";
  writeFileAtomically(script, slurmScript(jobs_, {array.tasks.name, array.folder, places_.program,
                                                  submitted_tasks_.size(), memory_mb}));
  writeTaskArray(array.tasks, array.folder);
  submission_.emplace(std::vector<std::string>{"sbatch", "--parsable", script.string()},
                      array.folder / "sbatch.out");
  submitted_array_ = number;
  arrays_[number] = std::move(array);
}

void SlurmEngine::cancel(std::size_t id) {
  const auto place = places_of_.find(id);
  if (place != places_of_.end())
    scancel({arrays_.at(place->second.array).job + "_" + std::to_string(place->second.index)});
}

std::string SlurmEngine::interrupt() {
  interrupted_ = true;
  if (submission_) {  // its job is to be known before anything is decided about it
    ToolCall::wait(*submission_, kAnswerLimit_s);
    pollSubmission();
  }
  const bool leave = leaves_jobs_();
  for (const auto& task : waiting_) ended_.push_back({task.id, 4, "", false, {}});
  waiting_.clear();
  std::set<std::string> jobs;
  for (const auto& [id, place] : places_of_) {
    jobs.insert(arrays_.at(place.array).job);
    if (leave) ended_.push_back({id, 4, "", true, {}});
  }
  const std::size_t left = places_of_.size();
  if (leave)
    places_of_.clear();
  else if (!jobs.empty())
    scancel({jobs.begin(), jobs.end()});
  next_question_ = Clock::now();
  if (!leave) return "interrupted: the jobs are cancelled; what runs is told to end";
  return "interrupted: " + std::to_string(left) +
         " tasks go on in the queue; the same command watches them again";
}

std::vector<EndedTask> SlurmEngine::ended() {
  if (!interrupted_) submitNext();
  pollSubmission();
  pollQueue();
  std::erase_if(arrays_, [](const auto& numbered) {
    const Array& array = numbered.second;
    const bool done = std::all_of(array.elements.begin(), array.elements.end(),
                                  [](const auto& e) { return e.over && e.told; });
    if (done) removeArray(array.folder);
    return done;
  });
  return std::exchange(ended_, {});
}

std::unique_ptr<Engine> makeSlurmEngine(const JobFile& jobs, const SlurmPlaces& places,
                                        std::function<bool()> leaves_jobs) {
  return std::make_unique<SlurmEngine>(jobs, places, std::move(leaves_jobs));
}

std::string slurmScriptOf(const JobFile& jobs, const SlurmPlaces& places, std::size_t tasks,
                          double memory_mb) {
  return slurmScript(jobs, {"roomgraph-1-...", folderOfArray(places.folder, 1), places.program,
                            std::min(tasks, kLargestArray), requestedMemory(jobs.slurm, memory_mb, 1)});
}

bool hasSlurmTasks(const fs::path& folder) {
  return !arrayFolders(folder).empty();
}

}  // namespace roomgraph
