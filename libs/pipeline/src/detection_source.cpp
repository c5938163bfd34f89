// SPDX-License-Identifier: BSD-3-Clause
// Check for idle detector and absent recorded boxes.
#include "roomgraph/pipeline/detection_source.h"

#include "roomgraph/datasets/rawlog_peek.h"

namespace roomgraph {

std::string missingDetections(const Stages& stages, const std::filesystem::path& rawlog) {
  if (!stages.detector || !stages.detector->idle()) return "";
  const RawlogPeek peek = peekRawlog(rawlog);
  if (peek.detections || !peek.frames) return "";
  return "no network named and no boxes " + std::string(peek.whole ? "in " : "at the beginning of ") +
         rawlog.filename().string() + ": objects will " +
         (peek.whole ? "not be mapped" : "be mapped only if boxes come later") +
         "; name one with --set detection.models=FILE.onnx, or install one ('roomgraph models list')";
}

}  // namespace roomgraph
