// SPDX-License-Identifier: BSD-3-Clause
// Progress line of a conversion that stops when the user interrupts it.
#include <iostream>

#include "bag_commands.h"
#include "interrupts.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/progress.h"

namespace roomgraph {

struct ShareProgress::Impl {
  Progress line;
  std::string output;
};

ShareProgress::ShareProgress(const std::string& label, std::string output)
    : impl_(new Impl{Progress(&std::cerr, label, "", 1), std::move(output)}) {
  catchInterrupts();
}

ShareProgress::~ShareProgress() = default;

std::function<void(double)> ShareProgress::function() {
  return [this](double share) {
    impl_->line.update(share);
    if (interrupted())
      throw Interrupted("interrupted" +
                        (impl_->output.empty() ? "" : ": " + impl_->output + " was not written"));
  };
}

void ShareProgress::finish() {
  impl_->line.finish();
}

}  // namespace roomgraph
