// SPDX-License-Identifier: BSD-3-Clause
// What was computed for the last few keys, kept: a recording has few cameras and many images.
#pragma once

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <utility>
#include <vector>

namespace roomgraph {

/// Safe from any thread. Values are to be cheap to copy, and shared ones (cv::Mat) not to be written to.
template <typename Key, typename Value>
class Recent {
 public:
  explicit Recent(std::size_t capacity) : capacity_(capacity) {}

  /// Of `make()` when the key is not among the last ones asked for. What `make` throws is thrown on, nothing kept.
  template <typename Make>
  Value of(const Key& key, Make make) {
    const std::lock_guard lock(mutex_);
    auto entry = std::find_if(entries_.begin(), entries_.end(), [&](const auto& e) { return e.first == key; });
    if (entry == entries_.end()) {
      Value made = make();
      if (entries_.size() == capacity_) entries_.pop_back();
      entry = entries_.emplace(entries_.end(), key, std::move(made));
    }
    std::rotate(entries_.begin(), entry, entry + 1);
    return entries_.front().second;
  }

 private:
  std::size_t capacity_;
  std::mutex mutex_;
  std::vector<std::pair<Key, Value>> entries_;  // the last one asked for first
};

}  // namespace roomgraph
