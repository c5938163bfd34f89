// SPDX-License-Identifier: BSD-3-Clause
// Networks of the detector, in the two formats that it reads, with their labels.
#include "../target.h"
#include "network.h"
#include "roomgraph/detection/register_classes.h"
#include "score_calibration.h"

namespace roomgraph::fuzz {
namespace {

ROOMGRAPH_FUZZ_TARGET(onnx) {
  detection::registerClasses();
  std::filesystem::create_directory(scratchFolder() / "onnx");
  writeParts(bytes, {"onnx/labels.txt", "onnx/x.onnx"});
  Network network({.file = (scratchFolder() / "onnx/x.onnx").string(), .input_size_px = 32});
}

ROOMGRAPH_FUZZ_TARGET(darknet) {
  detection::registerClasses();
  std::filesystem::create_directory(scratchFolder() / "darknet");
  writeParts(bytes, {"darknet/x.cfg", "darknet/labels.txt", "darknet/x.weights"});
  Network network({.file = (scratchFolder() / "darknet/x.weights").string()});
}

ROOMGRAPH_FUZZ_TARGET(labels) {
  readLabels(scratchFile("labels.txt", bytes).string());
}

ROOMGRAPH_FUZZ_TARGET(score_calibration) {
  scratchFile("x.scores.json", bytes);
  const auto scores = ScoreCalibration::beside((scratchFolder() / "x.onnx").string());
  const double p = scores.probability("door", scores.leastScore(0.35));
  if (!(p >= 0 && p <= 1)) std::abort();
}

}  // namespace
}  // namespace roomgraph::fuzz
