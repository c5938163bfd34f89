// SPDX-License-Identifier: BSD-3-Clause
// True boxes, detections and associations per frame, read from JSON lines.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>
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

/// Index of the frame whose stamp is nearest to t; -1 when none is within max_difference_s.
template <class Frame>
int nearestFrame(const std::vector<Frame>& frames, double t, double max_difference_s) {
  int nearest = -1;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double gap = std::abs(frames[i].t - t);
    if (gap > max_difference_s) continue;
    nearest = static_cast<int>(i);
    max_difference_s = std::nextafter(gap, -1);
  }
  return nearest;
}

}  // namespace roomgraph
