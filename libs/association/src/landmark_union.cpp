// SPDX-License-Identifier: BSD-3-Clause
// Fusion of two Gaussian estimates, of log odds, and of label votes.
#include "roomgraph/association/landmark_union.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace roomgraph {
namespace {

constexpr double kSurest = 0.999;
constexpr double kVotesOfAll = 0.5;  // pseudo-votes of each class, as LandmarkMap counts them

double logOdds(double p) {
  const double sure = std::clamp(p, 1 - kSurest, kSurest);
  return std::log(sure / (1 - sure));
}

// Votes that give this posterior.
void addVotes(const std::map<std::string, double>& posterior, double weight,
              std::map<std::string, double>& votes) {
  const double all = weight + kVotesOfAll * static_cast<double>(posterior.size());
  for (const auto& [name, p] : posterior) votes[name] += std::max(0.0, p * all - kVotesOfAll);
}

}  // namespace

double weightOfSightings(const CSemanticMap& map, const Landmark& landmark) {
  const auto found = map.weights.find(landmark.id);
  return found == map.weights.end() ? landmark.observations : found->second;
}

Landmark fusedEstimates(const Landmark& a, Landmark b) {
  Landmark out = a;
  const bool both_have_yaw = a.has_yaw && b.has_yaw;
  if (both_have_yaw && std::abs(wrapAngle(b.yaw - a.yaw)) > std::numbers::pi / 2) b.yaw = wrapAngle(b.yaw + std::numbers::pi);
  const Eigen::Matrix4d total = a.covariance + b.covariance;
  const Eigen::Matrix4d gain = total.ldlt().solve(a.covariance).transpose();
  Eigen::Vector4d step;
  step << b.position - a.position, both_have_yaw ? wrapAngle(b.yaw - a.yaw) : 0;
  const Eigen::Vector4d change = gain * step;
  out.position += change.head<3>();
  if (both_have_yaw) out.yaw = wrapAngle(a.yaw + change[3]);
  if (!a.has_yaw && b.has_yaw) out.yaw = b.yaw, out.has_yaw = true;
  out.covariance = a.covariance - gain * a.covariance;
  out.covariance = (out.covariance + out.covariance.transpose()).eval() / 2;
  const double seen_a = std::max(1, a.observations), seen_b = std::max(1, b.observations),
               weight = seen_b / (seen_a + seen_b);
  out.shape.width += weight * (b.shape.width - a.shape.width);
  out.shape.depth += weight * (b.shape.depth - a.shape.depth);
  out.shape.height += weight * (b.shape.height - a.shape.height);
  out.observations = a.observations + b.observations;
  return out;
}

double combinedExistence(double a, double b) {
  return std::clamp(1 / (1 + std::exp(-logOdds(a) - logOdds(b))), 1 - kSurest, kSurest);
}

std::map<std::string, double> combinedClasses(const std::map<std::string, double>& a, double weight_a,
                                              const std::map<std::string, double>& b, double weight_b) {
  std::map<std::string, double> votes;
  addVotes(a, weight_a, votes);
  addVotes(b, weight_b, votes);
  double total = 0;
  for (auto& [name, count] : votes) total += count += kVotesOfAll;
  for (auto& [name, count] : votes) count /= total;
  return votes;
}

}  // namespace roomgraph
