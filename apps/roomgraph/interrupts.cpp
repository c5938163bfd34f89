// SPDX-License-Identifier: BSD-3-Clause
// Signal handlers behind the interrupt flag; ignored signals stay ignored.
#include "interrupts.h"

#include <csignal>

namespace roomgraph {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t raised = 0;

void raise(int number) {
  raised = number;
  // A terminal that closes says so twice, the shell and the kernel: that is no wish to end at once.
  std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
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

bool interruptedByHand() {
  return raised == SIGINT;
}

}  // namespace roomgraph
