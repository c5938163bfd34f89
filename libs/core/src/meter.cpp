// SPDX-License-Identifier: BSD-3-Clause
// Processor time of a thread.
#include "roomgraph/core/meter.h"

#include <ctime>

namespace roomgraph {

double threadTime_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace roomgraph
