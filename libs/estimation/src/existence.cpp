// SPDX-License-Identifier: BSD-3-Clause
// Weights of the evidence for existence: the shipped ones, their parsing, and the probability.
#include "roomgraph/estimation/existence.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "roomgraph/core/errors.h"

namespace roomgraph {

ExistenceOptions::ExistenceOptions()
    : cylinder{"bias -19.7",     "filter 0.0621",   "sightings 0.686",     "score 5.18",
               "label 6.52",     "scatter -0.0995", "turned -0.575",       "measured 0.0764",
               "detected 0.46",  "contested -1.48", "outdone -9.87",       "mislabelled -1.85",
               "crossed -2.47",  "spread 3.13",     "beams_crossed -4.56", "above_filled -2.31",
               "confidence 9.28"},
      cuboid{"bias -8.21",          "filter 0.134",       "score 3.68",      "scatter -0.234",
             "turned -1.43",        "measured 0.686",     "detected 0.0946", "contested -0.554",
             "outdone -6.46",       "mislabelled -0.86",  "crossed -3.69",   "spread 2.15",
             "beams_crossed -6.82", "above_filled -2.11", "confidence 8.38"},
      planar{"bias -15.8",          "filter 0.13",        "sightings 0.367",      "directions 0.269",
             "score 4.61",          "label 2.96",         "scatter -0.0491",      "measured 0.969",
             "detected 0.304",      "contested -2.48",    "outdone -6.56",        "mislabelled -2.56",
             "crossed -2.48",       "spread 0.439",       "beside_crossed -6.09", "beside_filled 1.13",
             "beams_crossed -4.56", "above_filled -1.78", "confidence 12.4"} {}

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
