// SPDX-License-Identifier: BSD-3-Clause
// True boxes, detections and associations per frame, read from JSON lines.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "roomgraph/geometry/box.h"

namespace roomgraph {

// Truth and results per image: one line of JSON per frame. Stamps in s, boxes in px.

/// A true object in one image.
struct TrueBox {
  int id = -1;
  std::string class_name, kind;  ///< kind: finer than the class
  Box2 box;                      ///< of the visible pixels
  double visible = 1;            ///< share of the object's whole silhouette
};
struct TrueFrame {
  double t = 0;
  std::vector<TrueBox> boxes;
};

struct DetectedBox {
  std::string class_name;
  double score = 0;
  Box2 box;
};
struct DetectedFrame {
  double t = 0;
  std::vector<DetectedBox> boxes;
};

/// A measured object and the landmark it was given to.
struct AssociatedBox {
  std::string class_name;
  Box2 box;
  int landmark = -1;       ///< id; of the new landmark when is_new
  bool is_new = false;     ///< decided to be none of the landmarks so far
  double probability = 0;  ///< posterior of the decision; NaN: not in the file
};
struct AssociatedFrame {
  double t = 0;
  std::vector<AssociatedBox> boxes;
};

/// Read boxes.jsonl, detections.jsonl, associations.jsonl, in the order of the file. A run without detections
/// or associations leaves empty files; a truth file without frames is an error. Throw InputError with file
/// and line.
std::vector<TrueFrame> readTrueFrames(const std::filesystem::path& file);
std::vector<DetectedFrame> readDetections(const std::filesystem::path& file);
std::vector<AssociatedFrame> readAssociations(const std::filesystem::path& file);

/// Frames, in whatever order, to be found by their stamps.
class FramesByTime {
 public:
  template <class Frame>
  explicit FramesByTime(const std::vector<Frame>& frames) {
    for (const Frame& frame : frames) by_time_.emplace_back(frame.t, static_cast<int>(by_time_.size()));
    std::sort(by_time_.begin(), by_time_.end());
  }

  /// Index of the frame whose stamp is nearest to t, the first of several; -1 when none is within max_difference_s.
  int nearest(double t, double max_difference_s) const {
    const auto from = std::lower_bound(by_time_.begin(), by_time_.end(), std::pair(t, -1));
    int best = -1;
    const auto ask = [&](const std::pair<double, int>& frame) {
      const double gap = std::abs(frame.first - t);
      if (gap > max_difference_s || (best >= 0 && gap == max_difference_s && frame.second > best)) return;
      best = frame.second;
      max_difference_s = gap;
    };
    if (from != by_time_.end()) ask(*from);
    if (from != by_time_.begin())
      ask(*std::lower_bound(by_time_.begin(), from, std::pair(std::prev(from)->first, -1)));  // the first of its stamp
    return best;
  }

 private:
  std::vector<std::pair<double, int>> by_time_;
};

}  // namespace roomgraph
