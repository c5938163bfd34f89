// SPDX-License-Identifier: BSD-3-Clause
// Measurement of stage calls and their totals.
#include "roomgraph/pipeline/stage_times.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace roomgraph {
namespace {

// Resident pages: the second number of statm.
double residentMemory_mb() {
  std::ifstream statm("/proc/self/statm");
  double all = 0, resident = 0;
  if (!(statm >> all >> resident)) return 0;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

}  // namespace

void StageTimes::add(const char* stage, const Work& work) {
  calls_.push_back({t_, stage, work.ms, work.cpu_ms, memory_mb_});
}

StageTimes::Measured::Measured(StageTimes& times, const char* stage) : times_(times), stage_(stage) {}

StageTimes::Measured::~Measured() {
  const Work work = meter_.soFar();
  times_.memory_mb_ = residentMemory_mb();
  times_.add(stage_, work);
}

std::map<std::string, StageTimes::Totals> StageTimes::totals() const {
  std::map<std::string, Totals> out;
  for (const Call& call : calls_) {
    Totals& totals = out[call.stage];
    ++totals.calls;
    totals.total_ms += call.ms;
    totals.max_ms = std::max(totals.max_ms, call.ms);
  }
  return out;
}

}  // namespace roomgraph
