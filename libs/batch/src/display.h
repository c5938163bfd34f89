// SPDX-License-Identifier: BSD-3-Clause
// Progress of all runs of a batch: one display on a terminal, else one line for each event.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "roomgraph/batch/batch.h"

namespace roomgraph {

/// A task that runs now.
struct ShownTask {
  std::string name;
  double share = 0;  ///< negative: not known
  double elapsed_s = 0;
};

/// Counts of the runs of a batch.
struct ShownTotals {
  std::size_t done = 0, failed = 0, skipped = 0, all = 0;
  std::size_t running = 0, queued = 0;  ///< queued: in a queue, not begun
};

/// "1:02:03" or "2:03".
std::string clockText(double seconds);

/// "name  [#####.....]  50 %  0:12", as wide as `name_width` asks.
std::string taskLine(const ShownTask& task, std::size_t name_width);

/// Counts, time and time left, which is reckoned from what was done since the start.
std::string totalsLine(const ShownTotals& totals, const std::vector<ShownTask>& running, double elapsed_s);

class BatchDisplay {
 public:
  explicit BatchDisplay(const BatchView& view) : view_(view), start_(std::chrono::steady_clock::now()) {}
  ~BatchDisplay() { clear(); }
  BatchDisplay(const BatchDisplay&) = delete;
  BatchDisplay& operator=(const BatchDisplay&) = delete;

  /// Stays above the display.
  void event(const std::string& line);
  /// Whether draw() would draw now: five times a second at most, and on a terminal only.
  bool isDue() const;
  void draw(const ShownTotals& totals, const std::vector<ShownTask>& running);
  double elapsed() const;

 private:
  void clear();
  BatchView view_;
  std::chrono::steady_clock::time_point start_, last_;
  std::size_t lines_ = 0;
};

}  // namespace roomgraph
