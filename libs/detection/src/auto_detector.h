// SPDX-License-Identifier: BSD-3-Clause
// Detector that runs networks when configured and replays recorded boxes otherwise.
#pragma once

#include <string>
#include <vector>

#include "dnn_detector.h"
#include "recorded_detector.h"

namespace roomgraph {

/// Runs the networks when some are named, and replays recorded boxes otherwise.
class AutoDetector : public Detector {
  DEFINE_MRPT_OBJECT(AutoDetector, roomgraph)
 public:
  void declareParameters(ParameterVisitor& visitor) override;
  void setDatabase(const ObjectDatabase& database) override;
  void prepare() override;
  void setResultStore(ResultStore& store) override { networks_.setResultStore(store); }
  void feed(const CObservationDetections& recorded) override;
  /// No network, and no recorded boxes so far.
  bool idle() const override { return !networks_.hasModels() && records_.empty(); }
  Outcome<std::vector<Detection>> detect(const Frame& frame) override { return chosen().detect(frame); }
  bool due(const Frame& frame) override { return chosen().due(frame); }
  bool foresee(const Frame& frame) override { return networks_.hasModels() && networks_.foresee(frame); }
  std::vector<std::string> unsought() const override { return chosen().unsought(); }
  DetectorIdentity identity() const override { return chosen().identity(); }
  std::string warning() const override { return chosen().warning(); }

 private:
  Detector& chosen();
  const Detector& chosen() const;

  DnnDetector networks_;
  RecordedDetector records_;
};

}  // namespace roomgraph
