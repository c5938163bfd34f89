// SPDX-License-Identifier: BSD-3-Clause
// The thread beside the replay, and what ends it.
#include "examination.h"

#include <iostream>
#include <opencv2/core/utility.hpp>
#include <system_error>

#include "interrupts.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/progress.h"

namespace roomgraph {

Examination::Examination(std::filesystem::path input, SensorPoses poses)
    : input_(std::move(input)), poses_(std::move(poses)) {
  if (cv::getNumThreads() < 2) return;
  try {
    beside_ = std::async(std::launch::async, [this] { return look([](double) {}); });
  } catch (const std::system_error&) {
    // No thread is to be had: it can wait.
  }
}

Examination::Findings Examination::findings(bool quiet) {
  if (beside_.valid()) return beside_.get();
  Progress line(quiet ? nullptr : &std::cerr, "look at the recording", "%", 100);
  Findings out = look([&line](double share) { line.update(100 * share); });
  line.finish();
  return out;
}

Examination::Findings Examination::look(const std::function<void(double)>& progress) const {
  try {
    const auto watch = [&](double share) {
      progress(share);
      if (given_up_ || interrupted()) throw Interrupted("while the recording was examined");
    };
    return inspectRawlog(input_, watch, poses_).findings;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace roomgraph
