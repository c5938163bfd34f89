// SPDX-License-Identifier: BSD-3-Clause
// Greedy assignment: candidates sorted by probability, each landmark taken once.
#include "greedy_assignment.h"

#include <algorithm>
#include <set>

namespace roomgraph {
namespace {

struct Candidate {
  std::size_t measurement;
  LandmarkId landmark;
  double probability;
};

}  // namespace

std::vector<Association> assignGreedily(
    const std::vector<std::vector<std::pair<LandmarkId, double>>>& posteriors) {
  std::vector<Association> result(posteriors.size());
  std::vector<Candidate> candidates;
  for (std::size_t k = 0; k < posteriors.size(); ++k) {
    result[k].measurement = k;
    result[k].posterior = posteriors[k];
    for (const auto& [id, probability] : posteriors[k]) candidates.push_back({k, id, probability});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.probability > b.probability; });
  std::set<LandmarkId> taken;
  std::vector<char> served(posteriors.size(), 0);
  for (const auto& candidate : candidates) {
    if (served[candidate.measurement] || (candidate.landmark.valid() && taken.contains(candidate.landmark)))
      continue;
    served[candidate.measurement] = 1;
    taken.insert(candidate.landmark);
    result[candidate.measurement].landmark = candidate.landmark;
    result[candidate.measurement].probability = candidate.probability;
  }
  return result;
}

}  // namespace roomgraph
