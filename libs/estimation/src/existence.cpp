// SPDX-License-Identifier: BSD-3-Clause
// Weights of the evidence for existence: the shipped ones, their parsing, and the probability.
#include "roomgraph/estimation/existence.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "roomgraph/core/errors.h"

namespace roomgraph {

ExistenceOptions::ExistenceOptions()
    : cylinder{"bias -9.69",       "filter 0.283",   "sightings 0.653",  "directions 0.111",
               "score 4.71",       "label 4.12",     "scatter -0.204",   "turned -0.878",
               "measured 1.09",    "detected 0.627", "contested -0.686", "outdone -5.63",
               "mislabelled -4.2", "crossed -3.49",  "spread 1.13",      "beams_crossed -1.08",
               "above_filled -2"},
      cuboid{"bias -7.59",     "filter 0.224",    "sightings 0.0201", "score 3.07",
             "label 5.11",     "scatter -0.199",  "turned -2.23",     "measured 2.37",
             "detected 0.238", "contested -1.51", "outdone -4.38",    "mislabelled -4.26",
             "crossed -5.24",  "filled 0.0312",   "spread 1.43",      "beams_crossed -1.62"},
      planar{"bias -6.1",
             "filter 0.271",
             "sightings 0.379",
             "directions 0.832",
             "score 4.51",
             "label 3.58",
             "measured 0.598",
             "detected 0.319",
             "contested -1.06",
             "outdone -4.01",
             "mislabelled -5.09",
             "crossed -3.52",
             "beside_crossed -5.06",
             "beside_filled 0.396",
             "beams_crossed -1.1",
             "uneven -2.5"} {}

void ExistenceOptions::declareParameters(ParameterVisitor& v) {
  v.add("enabled", enabled,
        {.doc = "At the end of a run, existence follows from all its evidence; otherwise from the filter of "
                "[landmarks]."});
  v.add("least_probability", least_probability,
        {.doc = "At the end of a run, a landmark is in the map from this existence probability on.",
         .min = 0,
         .max = 1});
  v.add("least_sightings", least_sightings,
        {.doc = "At the end of a run, a landmark is in the map from this number of sightings on: the weights "
                "were fitted to such landmarks.",
         .min = 1,
         .max = 1000});
  v.add("least_planar_sightings", least_planar_sightings,
        {.doc = "The same for doors and other planar objects: the wall around it confirms what a single good view shows.",
         .min = 1,
         .max = 1000});
  v.add("cylinder_weights", cylinder,
        {.doc = "Weights of the evidence for the existence of round objects: \"NAME VALUE\", or \"bias "
                "VALUE\"; names that are left out have none."});
  v.add("cuboid_weights", cuboid, {.doc = "The same for box-shaped objects."});
  v.add("planar_weights", planar, {.doc = "The same for doors and other planar objects."});
}

ExistenceModel::Weights ExistenceModel::parse(const std::vector<std::string>& entries,
                                              const std::string& key) {
  Weights out;
  for (const auto& entry : entries) {
    std::istringstream in(entry);
    std::string name, rest;
    double value = 0;
    const bool understood = in >> name >> value && !(in >> rest);
    const auto known = std::find(ExistenceEvidence::kNames.begin(), ExistenceEvidence::kNames.end(), name);
    if (!understood || (name != "bias" && known == ExistenceEvidence::kNames.end()))
      throw ConfigError("[existence] " + key + ": '" + entry +
                        "' is no weight; expected \"NAME VALUE\", see docs/config.md");
    if (name == "bias") {
      out.bias = value;
    } else {
      out.of_evidence[static_cast<std::size_t>(known - ExistenceEvidence::kNames.begin())] = value;
    }
  }
  return out;
}

ExistenceModel::ExistenceModel(const ExistenceOptions& options)
    : weights_{{ShapeKind::kCylinder, parse(options.cylinder, "cylinder_weights")},
               {ShapeKind::kCuboid, parse(options.cuboid, "cuboid_weights")},
               {ShapeKind::kPlanar, parse(options.planar, "planar_weights")}} {}

double ExistenceModel::probability(ShapeKind kind, const ExistenceEvidence& evidence) const {
  const Weights& weights = weights_.at(kind);
  const auto values = evidence.values();
  double log_odds = weights.bias;
  for (std::size_t i = 0; i < values.size(); ++i) log_odds += weights.of_evidence[i] * values[i];
  return 1 / (1 + std::exp(-log_odds));
}

}  // namespace roomgraph
