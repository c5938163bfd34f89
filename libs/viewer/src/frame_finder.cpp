// SPDX-License-Identifier: BSD-3-Clause
// Search in the frames read last, then in the recording, from its beginning when need be.
#include "roomgraph/viewer/frame_finder.h"

#include <cmath>

namespace roomgraph {
namespace {

constexpr std::size_t kMostFrames = 50;
constexpr double kSameStamp_s = 1e-5, kOutOfOrder_s = 2;

}  // namespace

FrameFinder::FrameFinder(Open open) : open_(std::move(open)), thread_([this] { work(); }) {}

FrameFinder::~FrameFinder() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::shared_ptr<const Frame> FrameFinder::find(double t) {
  const std::lock_guard lock(mutex_);
  if (found_t_ == t) return found_;
  wanted_ = t;
  changed_.notify_all();
  return nullptr;
}

void FrameFinder::work() {
  std::unique_lock lock(mutex_);
  while (!stopped_) {
    if (!wanted_) {
      changed_.wait(lock);
      continue;
    }
    const double t = *wanted_;
    lock.unlock();
    std::shared_ptr<const Frame> frame;
    try {
      frame = read(t);
    } catch (const std::exception&) {  // the recording is gone: there is no image
    }
    lock.lock();
    if (wanted_ != t) continue;  // something else is wanted by now
    wanted_.reset();
    found_t_ = t;
    found_ = std::move(frame);
  }
}

std::shared_ptr<const Frame> FrameFinder::kept(double t) const {
  for (const auto& frame : last_read_)
    if (std::abs(frame->t - t) < kSameStamp_s) return frame;
  return nullptr;
}

std::shared_ptr<const Frame> FrameFinder::read(double t) {
  if (auto frame = kept(t)) return frame;
  if (!stream_ || last_read_.empty() || last_read_.back()->t > t) {
    last_read_.clear();
    stream_ = open_();
  }
  while (auto record = stream_->next()) {
    if (timeOf(*record) > t + kOutOfOrder_s) return nullptr;
    auto* frame = std::get_if<Frame>(&*record);
    if (!frame) continue;
    if (!frame->color.empty()) frame->depth.release();
    last_read_.push_back(std::make_shared<const Frame>(std::move(*frame)));
    if (last_read_.size() > kMostFrames) last_read_.pop_front();
    if (std::abs(last_read_.back()->t - t) < kSameStamp_s) return last_read_.back();
    const std::lock_guard lock(mutex_);
    if (stopped_ || wanted_ != t) return nullptr;
  }
  stream_.reset();
  return nullptr;
}

}  // namespace roomgraph
