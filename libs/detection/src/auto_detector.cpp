// SPDX-License-Identifier: BSD-3-Clause
// Delegation to the DNN or the recorded detector.
#include "auto_detector.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(AutoDetector, Detector, roomgraph)

// Both have a score_threshold: it is declared, and set, once.
void AutoDetector::declareParameters(ParameterVisitor& v) {
  networks_.declareParameters(v);
  records_.declareSource(v);
}

void AutoDetector::setDatabase(const ObjectDatabase& database) {
  networks_.setDatabase(database);
  records_.setDatabase(database);
}

void AutoDetector::prepare() {
  records_.setScoreThreshold(networks_.scoreThreshold());
  chosen().prepare();
}

void AutoDetector::feed(const CObservationDetections& recorded) {
  if (!networks_.hasModels()) records_.feed(recorded);
}

Detector& AutoDetector::chosen() {
  if (networks_.hasModels()) return networks_;
  return records_;
}

const Detector& AutoDetector::chosen() const {
  if (networks_.hasModels()) return networks_;
  return records_;
}

}  // namespace roomgraph
