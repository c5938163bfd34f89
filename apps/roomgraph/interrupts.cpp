// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "interrupts.h"

#include <csignal>

namespace roomgraph {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t raised = 0;

void raise(int) {
  raised = 1;
  for (const int signal : kSignals) std::signal(signal, SIG_DFL);
}

}  // namespace

void catchInterrupts() {
  // What is ignored stays so: nohup does that with SIGHUP.
  for (const int signal : kSignals)
    if (std::signal(signal, raise) == SIG_IGN) std::signal(signal, SIG_IGN);
}

bool interrupted() {
  return raised != 0;
}

}  // namespace roomgraph
