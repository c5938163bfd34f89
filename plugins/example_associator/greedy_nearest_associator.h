// SPDX-License-Identifier: BSD-3-Clause
// Example plug-in: greedy nearest-neighbour associator.
#pragma once

#include "roomgraph/association/associator.h"

namespace example {

/// Gives each measurement the nearest free landmark of its class on the ground; the nearest pair chooses
/// first.
class GreedyNearestAssociator : public roomgraph::Associator {
  DEFINE_MRPT_OBJECT(GreedyNearestAssociator, example)
 public:
  void declareParameters(roomgraph::ParameterVisitor& visitor) override;
  std::vector<roomgraph::Association> associate(const std::vector<roomgraph::WorldMeasurement>& measurements,
                                                const std::vector<roomgraph::Landmark>& landmarks) override;

 private:
  double gate_m_ = 0.5;
};

}  // namespace example
