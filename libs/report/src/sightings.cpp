// SPDX-License-Identifier: BSD-3-Clause
// Lines of associations to counts, probabilities, rivals and a histogram over time.
#include "sightings.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "roomgraph/core/json_integer.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

using nlohmann::json;

constexpr std::size_t kParts = 60, kMostRivals = 3;
constexpr double kSure = 0.9;

struct Growing {
  SightingSummary summary;
  double sum_probability = 0;
  std::map<int, double> rivals;
};

// Of the chosen landmark; rivals are all others that exist.
double splitPosterior(const json& measurement, int chosen, bool made_new, std::map<int, double>& rivals) {
  double probability = 0;
  for (const json& entry : measurement.at("posterior")) {
    const double p = entry.at("p").get<double>();
    const json& landmark = entry.at("landmark");
    const bool is_new = !landmark.is_number();
    if (is_new ? made_new : !made_new && integerOf<int>(landmark) == chosen) {
      probability += p;
    } else if (!is_new) {
      rivals[integerOf<int>(landmark)] += p;
    }
  }
  return probability;
}

void addSighting(const json& measurement, double t, double duration_s, std::map<int, Growing>& all) {
  const int id = integerOf<int>(measurement.at("landmark"));
  const bool made_new = measurement.at("new").get<bool>();
  Growing& of = all[id];
  SightingSummary& sum = of.summary;
  const double p = splitPosterior(measurement, id, made_new, of.rivals);
  if (sum.count == 0) {
    sum.first_t = t;
    sum.over_time.assign(kParts, 0);
  }
  sum.last_t = t;
  ++sum.count;
  sum.made_new += made_new;
  sum.doubtful += p < kSure;
  sum.least_probability = std::min(sum.least_probability, p);
  of.sum_probability += p;
  const double share = duration_s > 0 ? std::clamp(t / duration_s, 0., 1.) : 0;
  ++sum.over_time[std::min(kParts - 1, static_cast<std::size_t>(share * kParts))];
}

SightingSummary finished(Growing& of) {
  of.summary.mean_probability = of.sum_probability / of.summary.count;
  auto& rivals = of.summary.rivals;
  rivals.assign(of.rivals.begin(), of.rivals.end());
  std::stable_sort(rivals.begin(), rivals.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  rivals.resize(std::min(rivals.size(), kMostRivals));
  return of.summary;
}

}  // namespace

std::map<int, SightingSummary> readSightings(std::istream& lines, const std::string& name, double start_t,
                                             double duration_s) {
  std::map<int, Growing> all;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    try {
      const json frame = json::parse(line);
      const double t = frame.at("timestamp").get<double>() - start_t;
      for (const json& measurement : frame.at("measurements")) addSighting(measurement, t, duration_s, all);
    } catch (const json::exception& error) {
      throw InputError(name + ":" + std::to_string(number) + ": " + firstLine(error));
    }
  }
  std::map<int, SightingSummary> out;
  for (auto& [id, of] : all) out[id] = finished(of);
  return out;
}

}  // namespace roomgraph
