// SPDX-License-Identifier: BSD-3-Clause
// The frames of a run in which objects were measured; copies share them until one of them changes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "roomgraph/estimation/object_decision.h"
#include "roomgraph/observations/repeated_views.h"

namespace roomgraph {

/// An image that the detector saw.
struct SearchedImage {
  double t = 0;                       ///< s
  std::vector<std::string> unsought;  ///< classes that it did not look for

  /// Whether it did not look for this class.
  bool without(const std::string& class_name) const {
    return std::find(unsought.begin(), unsought.end(), class_name) != unsought.end();
  }
};

/// In order of time. A copy for another thread costs little; what is changed since is changed in one's own only.
class ObjectFrames {
 public:
  class Iterator {
   public:
    explicit Iterator(std::vector<std::shared_ptr<ObjectFrame>>::const_iterator at) : at_(at) {}
    const ObjectFrame& operator*() const { return **at_; }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    bool operator==(const Iterator&) const = default;

   private:
    std::vector<std::shared_ptr<ObjectFrame>>::const_iterator at_;
  };

  ObjectFrames() = default;
  ObjectFrames(const std::vector<ObjectFrame>& frames) {  // NOLINT: they are the same
    for (const ObjectFrame& frame : frames) add(frame);
  }

  void add(ObjectFrame frame) { frames_.push_back(std::make_shared<ObjectFrame>(std::move(frame))); }
  /// To be changed; other copies keep what it was. A thread keeps its copy until it is joined.
  ObjectFrame& change(std::size_t i) {
    if (frames_.at(i).use_count() > 1) frames_[i] = std::make_shared<ObjectFrame>(*frames_[i]);
    return *frames_[i];
  }

  /// The frames at these positions, which are in ascending order; `known`: what is kept of their sightings.
  void giveUp(const std::vector<std::size_t>& positions, const std::vector<FormerSighting>& known) {
    eraseAt(frames_, positions);
    std::vector<FormerSighting>& all = changeFormer();
    const auto middle = static_cast<std::ptrdiff_t>(all.size());
    all.insert(all.end(), known.begin(), known.end());
    std::inplace_merge(all.begin(), all.begin() + middle, all.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  }
  /// In order of time.
  const std::vector<FormerSighting>& former() const { return *former_; }
  /// To be changed as frames are.
  std::vector<FormerSighting>& changeFormer() {
    if (former_.use_count() > 1) former_ = std::make_shared<std::vector<FormerSighting>>(*former_);
    return *former_;
  }

  const ObjectFrame& operator[](std::size_t i) const { return *frames_[i]; }
  const ObjectFrame& back() const { return *frames_.back(); }
  std::size_t size() const { return frames_.size(); }
  bool empty() const { return frames_.empty(); }
  Iterator begin() const { return Iterator(frames_.begin()); }
  Iterator end() const { return Iterator(frames_.end()); }

 private:
  std::vector<std::shared_ptr<ObjectFrame>> frames_;
  std::shared_ptr<std::vector<FormerSighting>> former_ = std::make_shared<std::vector<FormerSighting>>();
};

}  // namespace roomgraph
