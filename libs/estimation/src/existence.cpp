// SPDX-License-Identifier: BSD-3-Clause
// Weights of the evidence for existence: the shipped ones, their parsing, and the probability.
#include "roomgraph/estimation/existence.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "roomgraph/core/errors.h"

namespace roomgraph {

ExistenceOptions::ExistenceOptions()
    : cylinder{"bias -17.9",  "filter 0.532",    "sightings 1.33", "directions 0.853",
               "score 5.93",  "label 9.4",       "scatter -0.518", "turned -0.955",
               "size -0.452", "contested -1.55", "spread 2.43",    "beams_crossed -9.52"},
      cuboid{"bias -7.48",     "filter 0.434",   "sightings 0.277",    "score 5.93",
             "label 3.38",     "scatter -0.209", "turned -2.33",       "contested -1.59",
             "crossed -0.468", "spread 1",       "beams_crossed -14.2"},
      planar{"bias -10.4",       "filter 0.383",         "sightings 0.853",    "directions 1.43",
             "score 4.31",       "label 4.96",           "scatter -0.0893",    "size -0.0477",
             "contested -0.426", "beside_crossed -14.2", "beside_filled 3.37", "beams_crossed -9.52"} {}

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
