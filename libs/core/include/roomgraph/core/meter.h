// SPDX-License-Identifier: BSD-3-Clause
// Time that a thread's work takes.
#pragma once

#include <chrono>

namespace roomgraph {

/// Processor time of the calling thread so far, ms.
double threadTime_ms();

/// Time on the wall, and on the processor of a thread.
struct Work {
  double ms = 0, cpu_ms = 0;
  void add(const Work& more) {
    ms += more.ms;
    cpu_ms += more.cpu_ms;
  }
};

/// Measures the work of a thread from now on.
class Meter {
 public:
  Work soFar() const {
    return {std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - started_).count(),
            threadTime_ms() - cpu_ms_};
  }

 private:
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  double cpu_ms_ = threadTime_ms();
};

}  // namespace roomgraph
