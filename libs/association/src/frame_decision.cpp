// SPDX-License-Identifier: BSD-3-Clause
// Frame decision from exclusive and non-exclusive alternatives by solveExclusive().
#include "frame_decision.h"

#include <algorithm>
#include <map>

#include "exclusive_assignment.h"

namespace roomgraph {
namespace {

double sum(const WeightedLandmarks& weights) {
  double out = 0;
  for (const auto& [id, weight] : weights) out += weight;
  return out;
}

Association decision(std::size_t k, const WeightedAlternatives& alternatives, const JointAssignment& joint,
                     const std::map<LandmarkId, Eigen::Index>& column) {
  Association out;
  out.measurement = k;
  const auto row = static_cast<Eigen::Index>(k);
  for (const auto& [id, weight] : alternatives.exclusive)
    out.posterior.emplace_back(id, std::min(1.0, joint.marginal(row, column.at(id))));
  const double scale = joint.none[row] / sum(alternatives.others);
  const std::pair<LandmarkId, double>* best = nullptr;
  for (const auto& other : alternatives.others) {
    out.posterior.emplace_back(other.first, scale * other.second);
    if (!best || other.second > best->second) best = &other;
  }
  out.landmark = best->first;
  for (const auto& [id, weight] : alternatives.exclusive)
    if (column.at(id) == joint.best[k]) out.landmark = id;
  for (const auto& [id, probability] : out.posterior)
    if (id == out.landmark) out.probability = probability;
  return out;
}

}  // namespace

std::vector<Association> decideFrame(const std::vector<WeightedAlternatives>& measurements) {
  std::map<LandmarkId, Eigen::Index> column;
  for (const auto& alternatives : measurements)
    for (const auto& [id, weight] : alternatives.exclusive)
      column.emplace(id, static_cast<Eigen::Index>(column.size()));
  Eigen::MatrixXd ratios = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(measurements.size()),
                                                 static_cast<Eigen::Index>(column.size()));
  for (std::size_t k = 0; k < measurements.size(); ++k)
    for (const auto& [id, weight] : measurements[k].exclusive)
      ratios(static_cast<Eigen::Index>(k), column.at(id)) = weight / sum(measurements[k].others);
  const JointAssignment joint = solveExclusive(ratios);
  std::vector<Association> out;
  for (std::size_t k = 0; k < measurements.size(); ++k)
    out.push_back(decision(k, measurements[k], joint, column));
  return out;
}

}  // namespace roomgraph
