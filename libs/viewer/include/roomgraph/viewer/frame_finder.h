// SPDX-License-Identifier: BSD-3-Clause
// FrameFinder: the image of an earlier moment, read from the recording again.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "roomgraph/datasets/record_stream.h"

namespace roomgraph {

/// Reads in a thread of its own. A rawlog can only be read from its beginning on; the frames read last are
/// kept, so that going back step by step does not begin anew each time.
class FrameFinder {
 public:
  using Open = std::function<std::unique_ptr<RecordStream>()>;
  explicit FrameFinder(Open open);
  ~FrameFinder();
  FrameFinder(const FrameFinder&) = delete;
  FrameFinder& operator=(const FrameFinder&) = delete;

  /// The frame with that stamp, s; null when it is not found yet (ask again) or not there.
  std::shared_ptr<const Frame> find(double t);

 private:
  void work();
  std::shared_ptr<const Frame> read(double t);
  std::shared_ptr<const Frame> kept(double t) const;

  Open open_;
  std::unique_ptr<RecordStream> stream_;                ///< of the thread
  std::deque<std::shared_ptr<const Frame>> last_read_;  ///< of the thread
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool stopped_ = false;
  std::optional<double> wanted_;
  double found_t_ = 0;
  std::shared_ptr<const Frame> found_;
  std::thread thread_;
};

}  // namespace roomgraph
