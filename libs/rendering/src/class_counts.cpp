// SPDX-License-Identifier: BSD-3-Clause
// Counts of a part against those of its whole.
#include "class_counts.h"

#include "roomgraph/rendering/scene_parts.h"

namespace roomgraph {

std::map<std::string, ClassCount> classCounts(const MapPicture& picture) {
  std::map<std::string, ClassCount> counts;
  for (const auto& landmark : picture.whole.landmarks) ++counts[landmark.class_name].whole;
  for (const auto& landmark : picture.shown.landmarks) ++counts[landmark.class_name].shown;
  return counts;
}

std::string withCount(const std::string& class_name, int count) {
  return inWords(class_name) + " (" + std::to_string(count) + ")";
}

}  // namespace roomgraph
