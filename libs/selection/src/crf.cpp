// SPDX-License-Identifier: BSD-3-Clause
// Min-sum and sum-product on a chain with the constraint "at least once".
#include "crf.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roomgraph {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// "At least once" becomes local with one more state per frame, its last: "none, and no proposal before"
// (fresh); state 0 is "none, but a proposal before". A chain that ends fresh is one without any proposal.
ChainProblem remembering(const ChainProblem& problem) {
  ChainProblem out;
  for (std::size_t f = 0; f < problem.unary.size(); ++f) {
    out.unary.push_back(problem.unary[f]);
    out.unary.back().push_back(problem.unary[f][0]);
    if (f + 1 == problem.unary.size()) break;
    const Eigen::MatrixXd& pair = problem.pairwise[f];
    Eigen::MatrixXd& table = out.pairwise.emplace_back(pair.rows() + 1, pair.cols() + 1);
    table.topLeftCorner(pair.rows(), pair.cols()) = pair;
    table.rightCols(1).setConstant(kInfinity);  // no state leads back to fresh …
    table.bottomRows(1).leftCols(pair.cols()) = pair.topRows(1);
    table(pair.rows(), 0) = kInfinity;  // … from which a chain continues as fresh or with a proposal
    table(pair.rows(), pair.cols()) = pair(0, 0);
  }
  if (out.unary.empty()) return out;
  out.unary.front()[0] = kInfinity;
  if (problem.must_appear) out.unary.back().back() = kInfinity;
  return out;
}

// log(sum of exp), stable; -infinity for none.
double logSum(const std::vector<double>& logs) {
  const double largest = *std::max_element(logs.begin(), logs.end());
  if (largest == -kInfinity) return largest;
  double sum = 0;
  for (const double value : logs) sum += std::exp(value - largest);
  return largest + std::log(sum);
}

// One message of sum-product: log sum over x of exp(from[x] - table(x, y) / temperature), for every y.
std::vector<double> message(const std::vector<double>& from, const Eigen::MatrixXd& table,
                            double temperature) {
  std::vector<double> out, terms(from.size());
  for (Eigen::Index y = 0; y < table.cols(); ++y) {
    for (std::size_t x = 0; x < from.size(); ++x)
      terms[x] = from[x] - table(static_cast<Eigen::Index>(x), y) / temperature;
    out.push_back(logSum(terms));
  }
  return out;
}

// Forward sums: [frame][state], logarithm of the weight of all choices up to the frame that end in the state.
std::vector<std::vector<double>> forwardSums(const ChainProblem& chain, double temperature) {
  std::vector<std::vector<double>> sums;
  for (std::size_t f = 0; f < chain.unary.size(); ++f) {
    sums.push_back(f == 0 ? std::vector<double>(chain.unary[0].size(), 0.0)
                          : message(sums.back(), chain.pairwise[f - 1], temperature));
    for (std::size_t x = 0; x < sums[f].size(); ++x) sums[f][x] -= chain.unary[f][x] / temperature;
  }
  return sums;
}

}  // namespace

ChainSolution minimize(const ChainProblem& problem) {
  ChainSolution solution;
  if (problem.unary.empty()) return solution;
  const ChainProblem chain = remembering(problem);
  const std::size_t frames = chain.unary.size();
  std::vector<double> cost = chain.unary[0];
  std::vector<std::vector<int>> from(frames);  // best state before, per frame and state
  for (std::size_t f = 1; f < frames; ++f) {
    std::vector<double> next = chain.unary[f];
    from[f].resize(next.size());
    for (std::size_t y = 0; y < next.size(); ++y) {
      double best = kInfinity;
      for (std::size_t x = 0; x < cost.size(); ++x) {
        const double sum = cost[x] + chain.pairwise[f - 1](static_cast<int>(x), static_cast<int>(y));
        if (sum > best) continue;
        best = sum;
        from[f][y] = static_cast<int>(x);
      }
      next[y] += best;
    }
    cost = std::move(next);
  }
  // Searched from the last proposal down, then the two kinds of "none": ties go to the higher state.
  int state = static_cast<int>(std::min_element(cost.rbegin() + 1, cost.rend()).base() - cost.begin()) - 1;
  if (cost.back() < cost[static_cast<std::size_t>(state)]) state = static_cast<int>(cost.size()) - 1;
  solution.energy = cost[static_cast<std::size_t>(state)];
  if (solution.energy == kInfinity) return solution;
  solution.states.resize(frames);
  for (std::size_t f = frames; f-- > 0;) {
    const bool fresh = state + 1 == static_cast<int>(chain.unary[f].size());
    solution.states[f] = fresh ? 0 : state;
    if (f > 0) state = from[f][static_cast<std::size_t>(state)];
  }
  return solution;
}

std::vector<std::vector<double>> marginals(const ChainProblem& problem, double temperature) {
  if (problem.unary.empty()) return {};
  const ChainProblem chain = remembering(problem);
  const auto forward = forwardSums(chain, temperature);
  const double partition = logSum(forward.back());
  if (partition == -kInfinity) return {};
  std::vector<std::vector<double>> out(chain.unary.size());
  std::vector<double> backward(chain.unary.back().size(), 0.0);
  for (std::size_t f = chain.unary.size(); f-- > 0;) {
    for (std::size_t x = 0; x < backward.size(); ++x)
      out[f].push_back(std::exp(forward[f][x] + backward[x] - partition));
    out[f][0] += out[f].back();  // both kinds of "none"
    out[f].pop_back();
    if (f == 0) break;
    for (std::size_t x = 0; x < backward.size(); ++x) backward[x] -= chain.unary[f][x] / temperature;
    backward = message(backward, chain.pairwise[f - 1].transpose(), temperature);
  }
  return out;
}

}  // namespace roomgraph
