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

/// What is known of the sightings of a frame when it is given up.
inline std::vector<FormerSighting> formerSightings(const ObjectFrame& frame) {
  std::vector<FormerSighting> out;
  for (const auto& [seen, association, landmark] : frame.decisions) {
    const ObjectMeasurement& measurement = seen.measurement;
    const Pose3 robot_from_object = frame.robot_from_camera * measurement.proposal.camera_from_object;
    out.push_back({frame.t, frame.frame, measurement.proposal.class_name, measurement.detection.box, landmark,
                   association.probability, robot_from_object.translation()});
  }
  return out;
}

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

  /// The frames at these positions, which are in ascending order: of their sightings little is kept.
  void giveUp(const std::vector<std::size_t>& positions) {
    for (const std::size_t i : positions)
      for (FormerSighting& sighting : formerSightings(*frames_[i])) former_.push_back(std::move(sighting));
    std::stable_sort(former_.begin(), former_.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
    eraseAt(frames_, positions);
  }
  /// In order of time.
  const std::vector<FormerSighting>& former() const { return former_; }
  std::vector<FormerSighting>& changeFormer() { return former_; }

  const ObjectFrame& operator[](std::size_t i) const { return *frames_[i]; }
  const ObjectFrame& back() const { return *frames_.back(); }
  std::size_t size() const { return frames_.size(); }
  bool empty() const { return frames_.empty(); }
  Iterator begin() const { return Iterator(frames_.begin()); }
  Iterator end() const { return Iterator(frames_.end()); }

 private:
  std::vector<std::shared_ptr<ObjectFrame>> frames_;
  std::vector<FormerSighting> former_;
};

}  // namespace roomgraph
