// SPDX-License-Identifier: BSD-3-Clause
// The engine of a cluster: gathers tasks into array jobs, submits them, looks at the queue and at the files
// that nodes leave.
#pragma once

#include <deque>
#include <map>
#include <set>

#include "roomgraph/batch/engine.h"
#include "slurm_queue.h"
#include "task_array.h"
#include "tool_call.h"

namespace roomgraph {

/// Indices of an array are below Slurm's MaxArraySize, which is 1001 where nobody has changed it.
inline constexpr std::size_t kLargestArray = 1000;

class SlurmEngine : public Engine {
 public:
  SlurmEngine(const JobFile& jobs, SlurmPlaces places, std::function<bool()> leaves_jobs);
  ~SlurmEngine() override;
  SlurmEngine(const SlurmEngine&) = delete;
  SlurmEngine& operator=(const SlurmEngine&) = delete;

  bool accepts(double expected_memory_mb) override;
  void start(const EngineTask& task) override;
  std::vector<EndedTask> ended() override;
  std::string interrupt() override;
  bool isElsewhere() const override { return true; }
  bool remembers(const std::vector<std::string>& command) const override;
  void takeUp(std::size_t id, const std::vector<std::string>& command) override;
  void cancel(std::size_t id) override;
  bool isQueued(std::size_t id) const override;
  std::vector<std::string> news() override { return std::exchange(news_, {}); }

 private:
  using Clock = ToolCall::Clock;
  /// A task in an array.
  struct Element {
    std::optional<std::size_t> id;  ///< nothing: of an earlier engine, not taken up
    bool over = false, told = false;
    std::string state = "PENDING";  ///< as the queue said last
    std::optional<Clock::time_point>
        left_at;  ///< when it was seen first that it is not in the queue any more
  };
  struct Array {
    std::filesystem::path folder;
    TaskArray tasks;
    std::string job;  ///< empty: not submitted yet
    Clock::time_point submitted;
    std::vector<Element> elements;
  };
  struct ElementPlace {
    std::size_t array = 0, index = 0;
  };

  void recallArray(const std::filesystem::path& folder);
  void submitNext();
  double memoryOf(const EngineTask& task) const;
  std::vector<EngineTask> nextTasks(double memory_mb);
  void pollSubmission();
  void refused(Array& array, const std::string& answer);
  void pollQueue();
  void takeIn(const SlurmQueue& queue, Clock::time_point asked);
  void look(Array& array, std::size_t index, const SlurmQueue& queue, bool known_job);
  void over(Array& array, std::size_t index, const TaskEnd& end);
  void scancel(std::vector<std::string> jobs);
  std::string jobOfName(const std::string& name);
  std::string stateInAccounting(const std::string& job, std::size_t index);
  std::filesystem::path answerFile(const char* name) const { return places_.folder / "slurm" / name; }

  JobFile jobs_;
  SlurmPlaces places_;
  std::function<bool()> leaves_jobs_;
  std::map<std::string, std::string> program_;  ///< files and stamps
  std::deque<EngineTask> waiting_;              ///< to be submitted
  Clock::time_point last_start_;
  std::map<std::size_t, Array> arrays_;  ///< by number
  std::size_t next_array_ = 1;
  std::map<std::size_t, ElementPlace> places_of_;   ///< of tasks
  std::map<std::string, ElementPlace> remembered_;  ///< by command
  std::vector<EndedTask> ended_;
  std::vector<std::string> news_;

  std::optional<ToolCall> submission_;
  std::size_t submitted_array_ = 0;
  std::vector<EngineTask> submitted_tasks_;
  std::size_t largest_array_;
  Clock::time_point not_before_;
  bool full_ = false;

  std::optional<ToolCall> question_;
  Clock::time_point next_question_;
  bool queue_silent_ = false, no_accounting_ = false, interrupted_ = false;
};

}  // namespace roomgraph
