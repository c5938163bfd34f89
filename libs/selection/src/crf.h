// SPDX-License-Identifier: BSD-3-Clause
// Chain-structured CRF: exact minimum energy and marginals.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace roomgraph {

/// The terms of paper Eq. 3 that concern one object over a window of frames. Given gamma they are a chain:
/// per frame one of the states {0: none, i: proposal i of 1..P}; P may be 0. "At most one proposal per frame"
/// (Eq. 7) holds by construction. Its factor (1 - beta*), of a term that is 0 or infinite, is left out.
struct ChainProblem {
  std::vector<std::vector<double>> unary;  ///< [frame][state]; +infinity forbids a state
  /// [frame](x, y): of state x in this frame and y in the next; one fewer than frames.
  std::vector<Eigen::MatrixXd> pairwise;
  bool must_appear =
      false;  ///< Eq. 7, "at least once in the N frames": all frames "none" has infinite energy
};

/// States of least energy.
struct ChainSolution {
  double energy = 0;        ///< infinite when no choice of states is allowed
  std::vector<int> states;  ///< per frame; empty when the energy is infinite. Ties go to the higher state.
};

/// Exact minimum by dynamic programming (min-sum), O(frames P^2).
ChainSolution minimize(const ChainProblem& problem);

/// Exact marginals [frame][state] of p(x) ~ exp(-E(x) / temperature) by forward and backward sums of
/// logarithms (sum-product). Each frame's sum to 1; empty when no choice of states is allowed.
std::vector<std::vector<double>> marginals(const ChainProblem& problem, double temperature);

}  // namespace roomgraph
