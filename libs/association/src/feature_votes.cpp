// SPDX-License-Identifier: BSD-3-Clause
// Votes of all points in one list, point after point.
#include "feature_votes.h"

#include <algorithm>
#include <unordered_map>

namespace roomgraph {

FeatureVotes::FeatureVotes(const std::vector<std::vector<WorldMeasurement>>& frames) {
  std::unordered_map<std::int64_t, std::uint32_t> numbers;
  std::vector<std::size_t> sightings;
  for (const auto& frame : frames) {
    auto& of_frame = points_.emplace_back();
    for (const WorldMeasurement& seen : frame) {
      auto& of_measurement = of_frame.emplace_back();
      for (const std::int64_t feature : seen.measurement.features) {
        const auto [number, is_new] = numbers.emplace(feature, static_cast<std::uint32_t>(numbers.size()));
        if (is_new) sightings.push_back(0);
        ++sightings[number->second];
        of_measurement.push_back(number->second);
      }
    }
  }
  begin_.push_back(0);
  for (const std::size_t count : sightings) begin_.push_back(begin_.back() + count);
  votes_.resize(begin_.back());
}

void FeatureVotes::count(const std::vector<std::vector<BatchDecision>>& decisions) {
  counted_ = !decisions.empty();
  if (!counted_) return;
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t f = 0; f < points_.size(); ++f)
    for (std::size_t k = 0; k < points_[f].size(); ++k)
      for (const std::uint32_t point : points_[f][k]) votes_[next[point]++] = decisions[f][k].landmark;
  for (std::size_t point = 0; point + 1 < begin_.size(); ++point)
    std::sort(votes_.begin() + static_cast<std::ptrdiff_t>(begin_[point]), votes_.begin() + static_cast<std::ptrdiff_t>(begin_[point + 1]));
}

// A point that others saw counts as one, divided among those that they saw it on.
void FeatureVotes::addVotes(std::size_t point, LandmarkId own, const std::vector<LandmarkId>& ids, std::vector<double>& owned,
                            double& total) const {
  const auto first = votes_.begin() + static_cast<std::ptrdiff_t>(begin_[point]);
  const auto last = votes_.begin() + static_cast<std::ptrdiff_t>(begin_[point + 1]);
  const auto others = static_cast<double>(last - first) - (std::binary_search(first, last, own) ? 1 : 0);
  if (others <= 0) return;
  total += 1;
  for (auto of_one = first; of_one != last;) {
    const LandmarkId id = *of_one;
    const auto next = std::find_if(of_one, last, [id](LandmarkId vote) { return vote != id; });
    const auto place = std::find(ids.begin(), ids.end(), id);
    if (place != ids.end()) owned[static_cast<std::size_t>(place - ids.begin())] += (static_cast<double>(next - of_one) - (id == own)) / others;
    of_one = next;
  }
}

std::vector<double> FeatureVotes::shares(std::size_t frame, std::size_t measurement, LandmarkId own, const std::vector<LandmarkId>& ids,
                                         double neutral) const {
  std::vector<double> owned(ids.size(), 0);
  double total = neutral;
  if (counted_)
    for (const std::uint32_t point : points_[frame][measurement]) addVotes(point, own, ids, owned, total);
  for (double& share : owned) share = (share + neutral / static_cast<double>(ids.size())) / total;
  return owned;
}

}  // namespace roomgraph
