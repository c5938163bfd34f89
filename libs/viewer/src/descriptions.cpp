// SPDX-License-Identifier: BSD-3-Clause
// Numbers in words, with as many digits as tell something.
#include "roomgraph/viewer/descriptions.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "roomgraph/geometry/degree.h"
#include "roomgraph/rendering/scene_parts.h"

namespace roomgraph {
namespace {

constexpr std::size_t kMostRivals = 3, kMostEvidence = 6;

[[gnu::format(printf, 1, 2)]] std::string printed(const char* format, ...) {
  char text[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

/// By value, the largest first.
template <class Key>
std::vector<std::pair<Key, double>> ranked(std::vector<std::pair<Key, double>> weights) {
  std::stable_sort(weights.begin(), weights.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.second) > std::abs(b.second); });
  return weights;
}

std::vector<std::string> classLines(const Landmark& landmark) {
  std::vector<std::string> lines;
  const auto& posterior = landmark.class_posterior;
  for (const auto& [name, p] : ranked<std::string>({posterior.begin(), posterior.end()}))
    if (p >= 0.005) lines.push_back(printed("%3.0f %%  %s", 100 * p, inWords(name).c_str()));
  return lines;
}

std::vector<std::string> placeLines(const Landmark& landmark) {
  const auto sigma = [&](int i) { return std::sqrt(std::max(landmark.covariance(i, i), 0.0)); };
  const auto& [x, y, z] = std::tuple{landmark.position.x(), landmark.position.y(), landmark.position.z()};
  std::vector<std::string> lines{
      printed("width %.2f m, depth %.2f m, height %.2f m", landmark.shape.width, landmark.shape.depth,
              landmark.shape.height),
      printed("x %.2f ± %.2f m, y %.2f ± %.2f m, z %.2f m", x, sigma(0), y, sigma(1), z)};
  if (landmark.has_yaw)
    lines.push_back(printed("front towards %.0f ± %.0f°", landmark.yaw * kDegreesPerRadian,
                            std::min(sigma(3) * kDegreesPerRadian, 180.0)));
  return lines;
}

std::vector<std::string> sightingLines(const std::vector<ShownSighting>& sightings, double start_t) {
  if (sightings.empty()) return {"none known"};
  double least = 1, sum = 0;
  int doubtful = 0;
  for (const auto& sighting : sightings) {
    least = std::min(least, sighting.probability);
    sum += sighting.probability;
    doubtful += sighting.probability < 0.9;
  }
  return {printed("%zu, from %.1f s to %.1f s", sightings.size(), sightings.front().t - start_t,
                  sightings.back().t - start_t),
          printed("association: mean p %.3f, least %.3f, %d below 0.9",
                  sum / static_cast<double>(sightings.size()), least, doubtful)};
}

std::vector<std::string> reasonLines(const ShownSighting& last, double start_t) {
  std::vector<std::string> lines{printed("at %.1f s, shape from %s, score %.2f", last.t - start_t,
                                         last.source.empty() ? "?" : last.source.c_str(), last.score)};
  std::string text;
  std::size_t count = 0;
  for (const auto& [id, p] : ranked<LandmarkId>(last.posterior))
    if (count++ < kMostRivals)
      text +=
          (text.empty() ? "" : ", ") +
          (id.valid() ? printed("#%lld %.3f", static_cast<long long>(id.value), p) : printed("new %.3f", p));
  if (!text.empty()) lines.push_back("p(landmark): " + text);
  const EnergyTerms& energy = last.energy;
  lines.push_back(printed("energy: unary %.2f, pairwise %.2f, high order %.2f", energy.unary, energy.pairwise,
                          energy.high_order));
  lines.push_back(
      printed("p(selected) %.3f%s", last.confidence, last.made_new ? "; it made the landmark" : ""));
  return lines;
}

std::vector<std::string> evidenceLines(const std::map<std::string, double>& evidence) {
  std::vector<std::string> lines;
  for (const auto& [name, value] : ranked<std::string>({evidence.begin(), evidence.end()}))
    if (lines.size() < kMostEvidence && value != 0)
      lines.push_back(printed("%+.2f  %s", value, name.c_str()));
  return lines;
}

std::string counted(std::size_t number, const char* one, const char* many) {
  return std::to_string(number) + " " + (number == 1 ? one : many);
}

}  // namespace

std::vector<TextBlock> describeLandmark(const ShownLandmark& shown,
                                        const std::vector<ShownSighting>& sightings, double start_t) {
  const Landmark& landmark = shown.landmark;
  std::vector<TextBlock> blocks;
  blocks.push_back(
      {printed("%s %lld", inWords(landmark.class_name).c_str(), static_cast<long long>(landmark.id.value)),
       {printed("existence %.3f, %s", landmark.existence, shown.in_map ? "in the map" : "not in the map")}});
  blocks.push_back({"Class", classLines(landmark)});
  blocks.push_back({"Size and place", placeLines(landmark)});
  blocks.push_back({"Sightings", sightingLines(sightings, start_t)});
  if (!sightings.empty()) blocks.push_back({"Last sighting", reasonLines(sightings.back(), start_t)});
  if (!shown.evidence.empty()) blocks.push_back({"Evidence of existence", evidenceLines(shown.evidence)});
  return blocks;
}

std::vector<float> sightingsOverTime(const std::vector<ShownSighting>& sightings, double from_t,
                                     double until_t, int parts) {
  std::vector<float> counts(static_cast<std::size_t>(parts), 0);
  for (const auto& sighting : sightings) {
    const double share = until_t > from_t ? (sighting.t - from_t) / (until_t - from_t) : 0;
    const int part = std::clamp(static_cast<int>(share * parts), 0, parts - 1);
    ++counts[static_cast<std::size_t>(part)];
  }
  const float most = std::max(1.f, *std::max_element(counts.begin(), counts.end()));
  for (float& count : counts) count /= most;
  return counts;
}

namespace {

// A finished run knows all of its closures at any time.
std::size_t closedBy(const ViewState& state) {
  if (!state.closures) return 0;
  return static_cast<std::size_t>(std::count_if(state.closures->begin(), state.closures->end(), [&](const auto& closure) {
    return std::max(closure.t_a, closure.t_b) <= state.t + 1e-3;
  }));
}

std::string inClosures(const ViewState& state) {
  const std::size_t closed = closedBy(state);
  if (closed == 0) return "";
  if (state.loop_closures == 0) return ", " + counted(closed, "loop closure", "loop closures");
  const std::string ties = ", " + counted(closed, "tie", "ties") + " of ";
  return ties + (closed == state.closures->size() ? std::to_string(state.loop_closures) + " loop closures" : "loop closures");
}

}  // namespace

std::string describeMoment(const ViewState& state, double start_t) {
  std::size_t mapped = 0, all = 0;
  if (state.landmarks)
    for (const auto& shown : *state.landmarks) ++all, mapped += shown->in_map;
  std::string text = counted(mapped, "object", "objects");
  if (state.record > 0) text = printed("record %d, %.1f s: ", state.record, state.t - start_t) + text;
  if (all > mapped) text += " (" + counted(all - mapped, "candidate", "candidates") + ")";
  if (state.key_poses) text += ", " + counted(state.key_poses->size(), "key pose", "key poses");
  text += inClosures(state);
  return state.note.empty() ? text : text + "; " + state.note;
}

std::string describeSpeed(double speed) {
  if (speed <= 0) return "max";
  return speed >= 1 ? printed("%g×", speed) : printed("1/%g×", 1 / speed);
}

}  // namespace roomgraph
