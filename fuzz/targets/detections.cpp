// SPDX-License-Identifier: BSD-3-Clause
// Recorded boxes, with a mask in a file of its own.
#include "../target.h"
#include "recorded_detector.h"

namespace roomgraph::fuzz {
namespace {

ROOMGRAPH_FUZZ_TARGET(recorded_boxes) {
  writeParts(bytes, {"recorded.jsonl", "mask.png"});
  readDetectionFile((scratchFolder() / "recorded.jsonl").string());
}

}  // namespace
}  // namespace roomgraph::fuzz
