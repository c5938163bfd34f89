// SPDX-License-Identifier: BSD-3-Clause
// Declaration of the landmark map's parameters, with defaults and ranges.
#include "roomgraph/association/landmark_options.h"

namespace roomgraph {

void LandmarkOptions::declareParameters(ParameterVisitor& v) {
  v.add("birth_existence", rules.birth_existence,
        {.doc = "existence probability of a landmark seen once", .min = 0.01, .max = 0.99});
  v.add("detection_probability", detection_probability,
        {.doc = "that an existing object in good view is detected", .min = 0.01, .max = 0.99});
  v.add("score_gain", score_gain,
        {.doc = "log of the likelihood ratio of existence per unit of a sighting's score",
         .min = 0,
         .max = 50});
  v.add("neutral_score", neutral_score,
        {.doc = "score of a sighting that speaks neither for nor against the object", .min = 0, .max = 1});
  v.add("false_alarm_probability", false_alarm_probability,
        {.doc = "that something is detected where there is no object", .min = 0.001, .max = 0.99});
  v.add("confirm_existence", confirm_existence, {.doc = "existence needed for the map", .min = 0, .max = 1});
  v.add("confirm_observations", confirm_observations,
        {.doc = "sightings needed for the map", .min = 1, .max = 1000});
  v.add("exclusive_overlap", exclusive_overlap,
        {.doc = "share of a footprint under another landmark above which only the better seen one is kept",
         .min = 0,
         .max = 1});
  v.add("ray_gain", ray_gain,
        {.doc = "log of the likelihood ratio of existence per ray that ends in the object, or passes through",
         .min = 0,
         .max = 10});
  rules.duplicates.declare(v);
}

}  // namespace roomgraph
