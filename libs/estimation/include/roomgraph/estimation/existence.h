// SPDX-License-Identifier: BSD-3-Clause
// What a whole run says about the existence of a landmark, and the probability that follows.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "roomgraph/core/parameters.h"
#include "roomgraph/observations/landmark.h"

namespace roomgraph {

/// Evidence for and against one landmark, of a whole run. Shares are in [0, 1]; means over sightings, and
/// `turned`, are weighted by the sightings' weights (initialisation score, less for carried boxes).
struct ExistenceEvidence {
  double filter = 0;      ///< log odds of the existence filter, clamped to [-4, 4]
  double sightings = 0;   ///< log(1 + sum of their weights, one for each key pose)
  double directions = 0;  ///< log(number of directions it was seen from)
  double score = 0;       ///< mean initialisation score of its sightings
  /// Mean score that the detector gave their boxes, as a share of the upper quartile of all in the run, at
  /// most 1.
  double confidence = 0;
  double label = 0;    ///< posterior of its class
  double scatter = 0;  ///< log of the sightings' mean squared normalised distance from it
  double turned = 0;   ///< share of the sightings whose yaw is another one, but for front and back
  double size = 0;     ///< normalised distance of its size from its class's
  double measured =
      0;  ///< share of the information on its longer side that is its sightings', not its class's
  double detected = 0;   ///< log odds of its being detected from a place with it in good view
  double contested = 0;  ///< share of sightings whose box another landmark, not seen in that frame, covers
  double outdone =
      0;  ///< share of sightings whose box has another label too, with a shape that fits it better
  double mislabelled = 0;  ///< share of sightings whose box has a surer label, of nothing that is mapped
  // Of what depth rays and beams crossed, the square roots of the shares: a little of a solid object says
  // nearly as much as a lot.
  double crossed = 0;         ///< of solid classes: of the solid part, by depth rays
  double filled = 0;          ///< share of its volume where they ended
  double spread = 0;          ///< share of its length or width, the lesser one, along which they ended in it
  double beside_crossed = 0;  ///< of doors: of the wall beside and above, by depth rays
  double beside_filled = 0;   ///< of doors: share of it where they ended
  double beams_crossed = 0;   ///< of solid classes: of the footprint, by lidar beams; of a cuboid also where they end deep inside it
  double above_filled = 0;  ///< of all but doors: share of the space above its middle where depth rays ended
  double uneven =
      0;  ///< of doors: by how much the shares that depth rays crossed differ below and at the top
  double missed_since = 0;  ///< visits after its last sighting to where it was sighted before, 5 at most: it may be gone
  double emptied = 0;  ///< of all but doors: share of where depth rays ended in it that they cross half a minute after its last sighting
  double shorter = 0;  ///< standard deviations by which its longer side is shorter than its class's, beyond two

  static constexpr std::array<std::string_view, 25> kNames = {
      "filter",        "sightings",    "directions", "score",     "label",          "scatter",
      "turned",        "size",         "measured",   "detected",  "contested",      "outdone",
      "mislabelled",   "crossed",      "filled",     "spread",    "beside_crossed", "beside_filled",
      "beams_crossed", "above_filled", "uneven",     "confidence", "missed_since", "emptied", "shorter"};
  /// In the order of kNames.
  std::array<double, kNames.size()> values() const {
    return {filter,        sightings,    directions, score,     label,          scatter,
            turned,        size,         measured,   detected,  contested,      outdone,
            mislabelled,   crossed,      filled,     spread,    beside_crossed, beside_filled,
            beams_crossed, above_filled, uneven,     confidence, missed_since, emptied, shorter};
  }
};

/// A landmark, in the map or not, with what speaks for and against it; its existence is the probability that
/// follows.
struct Candidate {
  Landmark landmark;
  ExistenceEvidence evidence;
};

/// [existence]
struct ExistenceOptions : Configurable {
  ExistenceOptions();
  bool enabled = true;
  double least_probability = 0.5;
  int least_sightings = 3, least_planar_sightings = 1;
  /// "NAME VALUE" for each kind of shape: weights of the evidence by kNames, and "bias".
  std::vector<std::string> cylinder, cuboid, planar;
  void declareParameters(ParameterVisitor& v) override;
  /// Whether a landmark whose existence is that of all evidence is in the map.
  bool isSure(const Landmark& landmark) const {
    const bool in_wall = landmark.shape.kind == ShapeKind::kPlanar;
    return landmark.existence >= least_probability &&
           landmark.observations >= (in_wall ? least_planar_sightings : least_sightings);
  }
};

/// Probability that a landmark exists, from evidence of the whole run: logistic regression, its log odds are
/// a weighted sum, with weights for each kind of shape. The shipped weights were fitted by
/// bench/existence.py.
class ExistenceModel {
 public:
  /// Throws ConfigError naming the key and the entry that is not understood.
  explicit ExistenceModel(const ExistenceOptions& options);
  double probability(ShapeKind kind, const ExistenceEvidence& evidence) const;

 private:
  struct Weights {
    double bias = 0;
    std::array<double, ExistenceEvidence::kNames.size()> of_evidence{};
  };
  static Weights parse(const std::vector<std::string>& entries, const std::string& key);
  std::map<ShapeKind, Weights> weights_;
};

}  // namespace roomgraph
