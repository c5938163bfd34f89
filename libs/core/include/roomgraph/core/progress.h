// SPDX-License-Identifier: BSD-3-Clause
// Progress line on a terminal or in a log: share done, rate, time left.
#pragma once

#include <chrono>
#include <cstddef>
#include <ostream>
#include <string>

namespace roomgraph {

/// One line of progress on a stream: share done, rate and time left. Rewrites the line on a terminal; prints
/// a line now and then otherwise. For display only: results do not depend on it.
class Progress {
 public:
  /// `total` in units of `unit` (0: unknown; empty unit: only the share is shown); silent when `out` is null.
  Progress(std::ostream* out, std::string label, std::string unit, double total);
  /// `done` counts like `total`; `note` is appended.
  void update(double done, const std::string& note = "");
  /// Ends the line.
  void finish(const std::string& note = "");

 private:
  std::string line(double done, const std::string& note) const;
  std::ostream* out_;
  std::string label_, unit_;
  double total_;
  bool terminal_;
  std::chrono::steady_clock::time_point start_, last_;
  std::size_t width_ = 0;
};

}  // namespace roomgraph
