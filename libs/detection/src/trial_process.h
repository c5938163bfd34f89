// SPDX-License-Identifier: BSD-3-Clause
// Work tried out in a copy of this process, which a crash does not end.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace roomgraph {

struct TrialLimits {
  unsigned cpu_s = 60;                          ///< processor time, s
  unsigned wall_s = 300;                        ///< time, s: what waits for something takes no processor time
  std::size_t memory_bytes = std::size_t{2} << 30;  ///< beyond what this process has
};

/// Does `work` in a forked process, with one thread of OpenCV. Empty when it came to an end, be it by an exception; else
/// how the process ended: "ended by signal 8 (Floating point exception)". For libraries that damaged input crashes; what the work
/// changes is lost. Also empty where no process can be made: then nothing was tried.
std::string fateOfTrial(const std::function<void()>& work, const TrialLimits& limits = {});

}  // namespace roomgraph
