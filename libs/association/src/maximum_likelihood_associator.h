// SPDX-License-Identifier: BSD-3-Clause
// Maximum-likelihood data association with a Gaussian gate and a constant density for new objects.
#pragma once

#include "roomgraph/association/associator.h"

namespace roomgraph {

/// Gaussian likelihood of the horizontal distance with the joint covariance against a constant floor for
/// "new"; each frame alone, the most probable pair first. For comparison with SoftAssociator.
class MaximumLikelihoodAssociator : public Associator {
  DEFINE_MRPT_OBJECT(MaximumLikelihoodAssociator, roomgraph)
 public:
  void declareParameters(ParameterVisitor& visitor) override;
  std::vector<Association> associate(const std::vector<WorldMeasurement>& measurements,
                                     const std::vector<Landmark>& landmarks) override;

 private:
  double gate_sigma_ = 3.0;
  double max_distance_ratio_ = 0.75;
  double new_density_per_m2_ = 0.05;
};

}  // namespace roomgraph
