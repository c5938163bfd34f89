// SPDX-License-Identifier: BSD-3-Clause
// Two movements in one view: that of the camera, and that of something before it.
#pragma once

#include <optional>

#include "pose_solver.h"

namespace roomgraph::tracking {

/// What is known beforehand.
struct PriorOfMovements {
  PosePrior predicted;
  bool measured = true;      ///< the prediction, by another sensor; else it is that the velocity goes on
  bool seen_lately = false;  ///< something moved; else now and then a few wrong matches agree
};

struct TwoMovements {
  PoseSolution camera;       ///< of the whole problem
  std::vector<char> moving;  ///< per observation: it goes with the other movement
};

/// `solution` solves the problem, with the most observations. Most of an image may show a person who walks by: where it is far from the
/// predicted one, the camera's movement is the one that agrees with that; else what it leaves out may move together. Nothing when there
/// is one movement only, or when the second one is that of something small.
std::optional<TwoMovements> tellApart(const PoseProblem& problem, const PoseSolution& solution, const PriorOfMovements& prior);

}  // namespace roomgraph::tracking
