// SPDX-License-Identifier: BSD-3-Clause
// Gated Gaussian likelihoods per measurement, normalised and assigned greedily.
#include "maximum_likelihood_associator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "greedy_assignment.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(MaximumLikelihoodAssociator, Associator, roomgraph)

namespace {

// Unnormalised posterior of one measurement over the landmarks of its class in gate, and "new" (invalid id).
std::vector<std::pair<LandmarkId, double>> likelihoods(const WorldMeasurement& seen,
                                                       const std::vector<Landmark>& landmarks,
                                                       double gate_sigma, double max_distance_ratio,
                                                       double new_density) {
  std::vector<std::pair<LandmarkId, double>> out;
  const auto& proposal = seen.measurement.proposal;
  for (const auto& landmark : landmarks) {
    if (landmark.class_name != proposal.class_name) continue;
    const Eigen::Vector2d apart = (seen.world_from_object.translation() - landmark.position).head<2>();
    // Objects farther apart than their size are two, however large the covariances are.
    const double reach = max_distance_ratio * std::max(proposal.shape.width, landmark.shape.width);
    if (apart.norm() > reach) continue;
    const Eigen::Matrix2d joint =
        seen.covariance.topLeftCorner<2, 2>() + landmark.covariance.topLeftCorner<2, 2>();
    const double squared = apart.dot(joint.inverse() * apart);
    if (squared > gate_sigma * gate_sigma) continue;
    out.emplace_back(landmark.id,
                     std::exp(-squared / 2) / (2 * std::numbers::pi * std::sqrt(joint.determinant())));
  }
  out.emplace_back(LandmarkId{}, new_density);
  return out;
}

void normalize(std::vector<std::pair<LandmarkId, double>>& posterior) {
  double sum = 0;
  for (const auto& [id, weight] : posterior) sum += weight;
  for (auto& [id, weight] : posterior) weight /= sum;
}

}  // namespace

void MaximumLikelihoodAssociator::declareParameters(ParameterVisitor& v) {
  v.add("gate_sigma", gate_sigma_,
        {.doc = "Farther landmarks, in standard deviations (Mahalanobis distance), are "
                "not candidates.",
         .min = 0.5,
         .max = 20});
  v.add("max_distance_ratio", max_distance_ratio_,
        {.doc = "Farther landmarks, in widths of the object between the centres, are not candidates.",
         .min = 0.1,
         .max = 5});
  v.add("new_density_per_m2", new_density_per_m2_,
        {.doc = "Prior density of new objects of one class on the floor.",
         .unit = "1/m^2",
         .min = 1e-6,
         .max = 100});
}

std::vector<Association> MaximumLikelihoodAssociator::associate(
    const std::vector<WorldMeasurement>& measurements, const std::vector<Landmark>& landmarks) {
  std::vector<std::vector<std::pair<LandmarkId, double>>> posteriors;
  for (const auto& seen : measurements) {
    posteriors.push_back(likelihoods(seen, landmarks, gate_sigma_, max_distance_ratio_, new_density_per_m2_));
    normalize(posteriors.back());
  }
  return assignGreedily(posteriors);
}

}  // namespace roomgraph
