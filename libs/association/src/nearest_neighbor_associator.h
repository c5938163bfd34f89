// SPDX-License-Identifier: BSD-3-Clause
// Nearest-neighbour data association within a gate relative to the object's width.
#pragma once

#include "roomgraph/association/associator.h"

namespace roomgraph {

/// The nearest landmark of the class within the gate, nearest pair first; else a new one. Probabilities are 1.
/// For comparison with SoftAssociator.
class NearestNeighborAssociator : public Associator {
  DEFINE_MRPT_OBJECT(NearestNeighborAssociator, roomgraph)
 public:
  void declareParameters(ParameterVisitor& visitor) override;
  std::vector<Association> associate(const std::vector<WorldMeasurement>& measurements,
                                     const std::vector<Landmark>& landmarks) override;

 private:
  double max_distance_ratio_ = 0.75;
};

}  // namespace roomgraph
