// SPDX-License-Identifier: BSD-3-Clause
// Signal handlers behind the interrupt flag; ignored signals stay ignored.
#include "interrupts.h"

#include <csignal>
#include <iterator>

namespace roomgraph {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t raised = 0;
volatile std::sig_atomic_t ignored[std::size(kSignals)] = {};

void raise(int number) {
  raised = number;
  // A terminal that closes says so twice, the shell and the kernel: that is no wish to end at once.
  for (std::size_t i = 0; i < std::size(kSignals); ++i)
    if (!ignored[i]) std::signal(kSignals[i], kSignals[i] == SIGHUP ? SIG_IGN : SIG_DFL);
}

}  // namespace

void catchInterrupts() {
  // What is ignored stays so, also after another signal: nohup does that with SIGHUP, a batch with SIGTERM.
  for (std::size_t i = 0; i < std::size(kSignals); ++i) {
    struct sigaction former {};
    sigaction(kSignals[i], nullptr, &former);
    ignored[i] = former.sa_handler == SIG_IGN;
    if (!ignored[i]) std::signal(kSignals[i], raise);
  }
}

bool interrupted() {
  return raised != 0;
}

bool interruptedByHand() {
  return raised == SIGINT;
}

}  // namespace roomgraph
