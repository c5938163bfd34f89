// SPDX-License-Identifier: BSD-3-Clause
// Examination: what `info` would say of the recording of a run.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <future>
#include <optional>
#include <vector>

#include "roomgraph/datasets/rawlog_report.h"

namespace roomgraph {

/// Reads the recording of a run once more, as far as the run goes, and looks for what is wrong with it: beside the replay, when the program may use
/// two threads, else when it is asked.
class Examination {
 public:
  using Findings = std::optional<std::vector<Finding>>;

  /// `until_s`: seconds from its beginning, 0: to its end.
  Examination(std::filesystem::path input, SensorPoses poses, double until_s);
  /// One that nobody waits for any more ends soon.
  ~Examination() { given_up_ = true; }
  Examination(const Examination&) = delete;
  Examination& operator=(const Examination&) = delete;

  /// Once. Nothing when it went wrong, which does not concern the run, or is interrupted.
  Findings findings(bool quiet);

 private:
  Findings look(const std::function<void(double)>& progress) const;

  std::filesystem::path input_;
  SensorPoses poses_;
  double until_s_;
  std::atomic<bool> given_up_ = false;
  std::atomic<double> share_ = 0;  ///< that the thread has read
  std::future<Findings> beside_;  ///< joined before the rest is gone
};

}  // namespace roomgraph
