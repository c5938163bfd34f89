// SPDX-License-Identifier: BSD-3-Clause
// Two independent estimates of one object as one landmark.
#pragma once

#include "roomgraph/observations/CSemanticMap.h"

namespace roomgraph {

/// Sum of the weights of a landmark's sightings. Of a map that does not say, as from a version before 2:
/// their number, as none weighs more than 1.
double weightOfSightings(const CSemanticMap& map, const Landmark& landmark);

/// Place and yaw by the information of both (a yaw that is the opposite one is turned), size by their
/// sightings, and the sum of these. Id, class and existence are those of `a`.
Landmark fusedEstimates(const Landmark& a, Landmark b);

/// Sum of the log odds of two probabilities, as a probability in [0.001, 0.999]: what says one nearly surely
/// may still be overruled.
double combinedExistence(double a, double b);

/// Class posterior of both, whose sightings have these weights: votes with an even Dirichlet prior over the
/// classes seen, as in LandmarkMap.
std::map<std::string, double> combinedClasses(const std::map<std::string, double>& a, double weight_a,
                                              const std::map<std::string, double>& b, double weight_b);

}  // namespace roomgraph
