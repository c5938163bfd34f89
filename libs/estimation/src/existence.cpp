// SPDX-License-Identifier: BSD-3-Clause
// Weights of the evidence for existence: the shipped ones, their parsing, and the probability.
#include "roomgraph/estimation/existence.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "roomgraph/core/errors.h"

namespace roomgraph {

ExistenceOptions::ExistenceOptions()
    : cylinder{"bias -9.62",       "filter 0.257",  "sightings 0.643", "directions 0.0785",
               "score 5.1",        "label 4.22",    "turned -1.06",    "detected 0.55",
               "contested -0.924", "crossed -3.51", "spread 1.56",     "beams_crossed -1.05"},
      cuboid{"bias -6.73",    "filter 0.189", "sightings 0.165", "score 3.38",
             "label 3.59",    "turned -2.64", "detected 0.245",  "contested -1.28",
             "crossed -5.24", "filled 0.238", "spread 2.21",     "beams_crossed -1.55"},
      planar{"bias -5.02",    "filter 0.206",         "sightings 0.643",      "directions 0.654",
             "score 2.8",     "label 3.24",           "detected 0.312",       "contested -1.13",
             "crossed -3.52", "beside_crossed -4.74", "beside_filled 0.0577", "beams_crossed -1.07"} {}

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
