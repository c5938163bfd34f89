// SPDX-License-Identifier: BSD-3-Clause
// The thread beside the replay, and what ends it.
#include "examination.h"

#include <chrono>
#include <iostream>
#include <opencv2/core/utility.hpp>
#include <system_error>

#include "interrupts.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/progress.h"

namespace roomgraph {
namespace {

constexpr auto kLook = std::chrono::milliseconds(100);

}  // namespace

Examination::Examination(std::filesystem::path input, SensorPoses poses, double until_s)
    : input_(std::move(input)), poses_(std::move(poses)), until_s_(until_s) {
  if (cv::getNumThreads() < 2) return;
  try {
    beside_ = std::async(std::launch::async, [this] { return look([this](double share) { share_ = share; }); });
  } catch (const std::system_error&) {
    // No thread is to be had: it can wait.
  }
}

Examination::Findings Examination::findings(bool quiet) {
  Progress line(quiet ? nullptr : &std::cerr, "look at the recording", "%", 100);
  const bool beside = beside_.valid();
  while (beside && beside_.wait_for(kLook) != std::future_status::ready) line.update(100 * share_);
  Findings out = beside ? beside_.get() : look([&line](double share) { line.update(100 * share); });
  line.finish();
  return out;
}

Examination::Findings Examination::look(const std::function<void(double)>& progress) const {
  try {
    const auto watch = [&](double share) {
      progress(share);
      if (given_up_ || interrupted()) throw Interrupted("while the recording was examined");
    };
    return inspectRawlog(input_, watch, poses_, until_s_).findings;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace roomgraph
