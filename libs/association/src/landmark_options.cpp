// SPDX-License-Identifier: BSD-3-Clause
// Declaration of the landmark map's parameters, with defaults and ranges.
#include "roomgraph/association/landmark_options.h"

namespace roomgraph {

void LandmarkOptions::declareParameters(ParameterVisitor& v) {
  v.add(
      "enabled", enabled,
      {.doc =
           "Whether objects are mapped. false: they are detected, and people are kept out of odometry, scans "
           "and grid, but there are no landmarks."});
  v.add(
      "doubt_by_scan", doubt_by_scan,
      {.doc =
           "Whether measured shapes whose solid part the beams of the latest scan pass through lose score."});
  v.add("hindsight", hindsight,
        {.doc = "Whether at the end of a run it is decided again which landmark was measured, with all that "
                "is known then."});
  v.add("birth_existence", rules.birth_existence,
        {.doc = "Existence probability of a new landmark.", .min = 0.01, .max = 0.99});
  v.add("detection_probability", detection_probability,
        {.doc = "Probability that an object in good view is detected.", .min = 0.01, .max = 0.99});
  v.add(
      "score_gain", score_gain,
      {.doc = "Log likelihood ratio of existence per unit by which a sighting's score exceeds neutral_score.",
       .min = 0,
       .max = 50});
  v.add("neutral_score", neutral_score,
        {.doc = "Score of a sighting that is evidence neither for nor against the object.",
         .min = 0,
         .max = 1});
  v.add(
      "false_alarm_probability", false_alarm_probability,
      {.doc = "Probability that something is detected where there is no object.", .min = 0.001, .max = 0.99});
  v.add("confirm_existence", confirm_existence,
        {.doc = "While a run goes on, a landmark is confirmed from this existence probability on; at its end "
                "[existence] says what is in the map, if enabled.",
         .min = 0,
         .max = 1});
  v.add("confirm_observations", confirm_observations,
        {.doc = "The same of the number of its sightings.", .min = 1, .max = 1000});
  v.add("exclusive_overlap", exclusive_overlap,
        {.doc = "Of two landmarks that overlap by more than this share of the smaller one's footprint, only "
                "the one with "
                "more evidence is in the map. Things of two classes that frames show beside each other, as chairs "
                "at a table, may overlap by half of it.",
         .min = 0,
         .max = 1});
  v.add(
      "ray_gain", ray_gain,
      {.doc =
           "Log likelihood ratio of existence per lidar beam that ends in the object (for) or passes through "
           "it (against).",
       .min = 0,
       .max = 10});
  rules.duplicates.declare(v);
}

}  // namespace roomgraph
