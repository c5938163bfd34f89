// SPDX-License-Identifier: BSD-3-Clause
// Weights of the evidence for existence: the shipped ones, their parsing, and the probability.
#include "roomgraph/estimation/existence.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "roomgraph/core/errors.h"

namespace roomgraph {

ExistenceOptions::ExistenceOptions()
    : cylinder{"bias -20.3",     "filter 0.0636",   "sightings 0.668",     "score 5.15",
               "label 6.6",      "scatter -0.0926", "turned -0.575",       "measured 0.0647",
               "detected 0.454", "contested -1.5",  "outdone -10.1",       "mislabelled -1.74",
               "crossed -2.48",  "spread 3.16",     "beams_crossed -4.56", "above_filled -2.3",
               "confidence 9.94", "missed_since -0.75", "emptied -6"},
      cuboid{"bias -8.4",           "filter 0.135",       "score 3.66",      "scatter -0.229",
             "turned -1.43",        "measured 0.682",     "detected 0.0917", "contested -0.547",
             "outdone -6.53",       "mislabelled -0.787", "crossed -3.7",    "spread 2.17",
             "beams_crossed -6.83", "above_filled -2.1",  "confidence 8.61", "missed_since -0.75", "emptied -6", "shorter -3"},
      planar{"bias -16.1",          "filter 0.13",        "sightings 0.359",      "directions 0.273",
             "score 4.61",          "label 2.99",         "scatter -0.0467",      "measured 0.954",
             "detected 0.301",      "contested -2.48",    "outdone -6.66",        "mislabelled -2.5",
             "crossed -2.48",       "spread 0.443",       "beside_crossed -6.11", "beside_filled 1.15",
             "beams_crossed -4.57", "above_filled -1.77", "confidence 12.7", "missed_since -0.75"} {}

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
        {.doc = "The same for doors and other planar objects: the wall around it confirms what a single good "
                "view shows.",
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
