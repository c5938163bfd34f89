// SPDX-License-Identifier: BSD-3-Clause
// Scores of a network as probabilities, and what makes them so.
#pragma once

#include <map>
#include <string>

namespace roomgraph {

/// Makes a network's scores the probability that a box is one of its class: the logit of the score is stretched and shifted,
/// class by class (Platt, "Probabilistic Outputs for Support Vector Machines", 1999).
class ScoreCalibration {
 public:
  /// Of "<network without its ending>.scores.json", which `bench/calibrate_scores.py` writes:
  /// {"classes": {"swivel_chair": {"slope": 1.9, "shift": -0.2}}}; where there is none, scores stay as they are. Throws InputError
  /// with file and cause.
  static ScoreCalibration beside(const std::string& network);

  /// Of a box of this class; classes that the file does not name keep their score.
  double probability(const std::string& class_name, double score) const;
  /// Boxes with a smaller score have a smaller probability than `probability`, whatever their class.
  double leastScore(double probability) const;
  /// fileHash() of its file; empty where there is none.
  const std::string& hash() const { return hash_; }

 private:
  struct Line {
    double slope = 1, shift = 0;
  };
  std::map<std::string, Line> lines_;
  std::string hash_;
};

}  // namespace roomgraph
