// SPDX-License-Identifier: BSD-3-Clause
// An upper limit of threads for a command.
#pragma once

#include <tbb/global_control.h>

#include <cstdlib>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace roomgraph {

/// No more than so many threads of TBB (during its lifetime), of OpenCV and, where none is running yet, of Mesa's software
/// renderer (from now on) in this process; 0: no limit.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads) {
    if (threads <= 0) return;
    limit_.emplace(tbb::global_control::max_allowed_parallelism, threads);
    cv::setNumThreads(threads);
    // Its own threads come to the caller's: with 0 the caller draws.
    setenv("LP_NUM_THREADS", std::to_string(threads - 1).c_str(), 0);
  }

 private:
  std::optional<tbb::global_control> limit_;
};

}  // namespace roomgraph
