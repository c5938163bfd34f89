// SPDX-License-Identifier: BSD-3-Clause
// Release by reception time and memory; mutual nearest neighbours of colour and depth.
#include "record_queue.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace roomgraph::bags {
namespace {

constexpr std::size_t kMostBytes = 512u << 20;

std::int64_t nanosecondsOf(double seconds) {
  return static_cast<std::int64_t>(std::llround(1e9 * seconds));
}

std::size_t bytesIn(const cv::Mat& image) {
  return image.total() * image.elemSize();
}

}  // namespace

RecordQueue::RecordQueue(double window_s, double pair_s)
    : window_ns_(nanosecondsOf(window_s)), pair_ns_(nanosecondsOf(pair_s)) {}

void RecordQueue::noteReception(std::int64_t received_ns) {
  now_ns_ = std::max(now_ns_, received_ns);
}

void RecordQueue::push(WaitingRecord record) {
  noteReception(record.received_ns);
  bytes_ += record.bytes;
  const auto t = record.t_ns;
  records_.emplace(t, std::move(record));
}

void RecordQueue::pushDepth(std::int64_t t_ns, std::int64_t received_ns, cv::Mat depth) {
  noteReception(received_ns);
  bytes_ += bytesIn(depth);
  depths_.emplace(t_ns, WaitingDepth{received_ns, std::move(depth)});
}

// Depth images whose colour image would have come long ago.
void RecordQueue::forgetDepths() {
  while (!depths_.empty() && depths_.begin()->second.received_ns + 2 * window_ns_ < now_ns_) {
    bytes_ -= bytesIn(depths_.begin()->second.image);
    depths_.erase(depths_.begin());
    ++unpaired_depth_;
  }
}

std::optional<WaitingRecord> RecordQueue::pop(bool all) {
  const auto first = records_.begin();
  const bool due = first != records_.end() &&
                   (all || bytes_ >= kMostBytes || first->second.received_ns + window_ns_ < now_ns_);
  // Only now: behind a pause of the recorder, images from before it still wait for theirs.
  if (!due) {
    forgetDepths();
    return std::nullopt;
  }
  WaitingRecord record = std::move(first->second);
  records_.erase(first);
  bytes_ -= record.bytes;
  return record;
}

cv::Mat RecordQueue::takeDepth(std::int64_t t_ns) {
  auto nearest = depths_.end();
  for (auto depth = depths_.lower_bound(t_ns - pair_ns_);
       depth != depths_.end() && depth->first <= t_ns + pair_ns_; ++depth)
    if (nearest == depths_.end() || std::abs(depth->first - t_ns) < std::abs(nearest->first - t_ns))
      nearest = depth;
  if (nearest == depths_.end()) return {};
  // It may belong to a later colour image that is nearer to it.
  const auto distance = std::abs(nearest->first - t_ns);
  for (auto later = records_.lower_bound(nearest->first - distance + 1);
       later != records_.end() && later->first < nearest->first + distance; ++later)
    if (later->second.is_color) return {};
  cv::Mat image = std::move(nearest->second.image);
  bytes_ -= bytesIn(image);
  depths_.erase(nearest);
  return image;
}

void RecordQueue::clear() {
  unpaired_depth_ += static_cast<int>(depths_.size());
  depths_.clear();
  records_.clear();
  bytes_ = 0;
}

}  // namespace roomgraph::bags
