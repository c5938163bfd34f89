// SPDX-License-Identifier: BSD-3-Clause
// Label lists of COCO and ADE20K in network order.
#pragma once

#include <string>
#include <vector>

namespace roomgraph {

/// Labels of a public data set in the order in which networks trained on it give them.
struct LabelList {
  std::string name;
  std::vector<std::string> labels;
};

/// Lists that come with the program, each of another length: COCO (80), ADE20K (150, 151 with the background
/// first, 32 for the background and the 31 most frequent classes).
const std::vector<LabelList>& labelLists();

/// Name of a COCO class index ("person" … "toothbrush"); empty when it is not in [0, 80).
const char* cocoLabel(int index);

}  // namespace roomgraph
