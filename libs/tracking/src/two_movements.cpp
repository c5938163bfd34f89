// SPDX-License-Identifier: BSD-3-Clause
// A solution that the prediction holds, and one of what the camera's leaves out.
#include "two_movements.h"

#include <algorithm>
#include <limits>

namespace roomgraph::tracking {
namespace {

constexpr double kFar_sigma = 2;        // from the prediction: the movement may be that of something else
constexpr int kLeastHeld = 20;          // observations that agree with the prediction,
constexpr int kLeastWithout = 30;       // where no other sensor measured it: a velocity does not tell much
constexpr double kMuchWorse = 1.5;      // times the cost these have in the far movement; without movers at most 1.2 was seen
constexpr double kMostCost = 9;         // of an observation: it may be wrong
constexpr double kLeastShare = 0.1;     // and such a share of the far movement's: a few may go along with the camera
constexpr double kCoarse = 2;           // times the finest feature's standard deviation in the image
constexpr double kSlips_sigma = 4;      // from the prediction, without any that agrees with it: what predicted has erred
constexpr int kLeastTogether = 10;      // observations of something that moves:
constexpr double kShareTogether = 0.6;  // of what the camera's movement leaves out,
constexpr int kSurelyTogether = 20;     // or so many: of wrong matches no more than 13 were seen to agree
constexpr double kLeastMover = 0.2;     // of those of the camera's movement, if nothing moved lately

PoseProblem part(const PoseProblem& problem, const std::vector<char>& kept) {
  PoseProblem out{problem.camera, {}, {}};
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (!kept[i]) continue;
    out.points.push_back(problem.points[i]);
    out.observations.push_back(problem.observations[i]);
  }
  return out;
}

// Of a part of the problem, as one of the whole.
PoseSolution inWhole(PoseSolution solution, const std::vector<char>& kept) {
  std::vector<char> inlier(kept.size(), 0);
  for (std::size_t i = 0, next = 0; i < kept.size(); ++i)
    if (kept[i]) inlier[i] = solution.inlier[next++];
  solution.inlier = std::move(inlier);
  return solution;
}

std::vector<char> without(const std::vector<char>& some) {
  std::vector<char> out;
  for (const char one : some) out.push_back(!one);
  return out;
}

// Coarse features go along with any movement.
std::vector<char> fineOf(const PoseProblem& problem) {
  double finest = std::numeric_limits<double>::infinity();
  for (const Observation& one : problem.observations) finest = std::min(finest, one.pixel_sigma);
  std::vector<char> out;
  for (const Observation& one : problem.observations) out.push_back(one.pixel_sigma < kCoarse * finest);
  return out;
}

int countOf(const std::vector<char>& some) { return static_cast<int>(std::count(some.begin(), some.end(), 1)); }

double costOf(const std::vector<double>& errors, const std::vector<char>& of) {
  double sum = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) sum += of[i] ? std::min(errors[i], kMostCost) : 0;
  return sum;
}

// What agrees with the prediction, which counts as a measurement.
PoseSolution heldBy(const PosePrior& prediction, const PoseProblem& problem) {
  const std::vector<char> fine = fineOf(problem);
  PoseProblem held = part(problem, fine);
  held.prior = prediction;
  return inWhole(refinePose(held, prediction.camera_from_world, true), fine);
}

// The movement that the prediction holds is the camera's if what agrees with it fits the first one much worse. Where the camera alone
// moves, the movement of most fits any part of them as well as one that is held elsewhere.
std::optional<TwoMovements> heldApart(const PoseProblem& problem, const PoseSolution& first, const PriorOfMovements& prior) {
  TwoMovements out{heldBy(prior.predicted, problem), {}};
  PoseSolution& held = out.camera;
  const std::vector<double> errors = pixelErrors(problem, held.camera_from_world), by_first = pixelErrors(problem, first.camera_from_world);
  if (costOf(by_first, held.inlier) < kMuchWorse * costOf(errors, held.inlier)) return std::nullopt;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    out.moving.push_back(first.inlier[i] && !agrees(errors[i]));
    held.inlier[i] = agrees(errors[i]) && (errors[i] < 1 || errors[i] < by_first[i]);
  }
  held.inliers = countOf(held.inlier);
  const double least = std::max(1. * (prior.measured ? kLeastHeld : kLeastWithout), kLeastShare * first.inliers);
  return held.inliers < least || countOf(out.moving) < kLeastTogether ? std::nullopt : std::optional(out);
}

// What the camera's movement leaves out may agree with another one.
std::optional<TwoMovements> movesElsewhere(const PoseProblem& problem, const PoseSolution& camera, const PriorOfMovements& prior) {
  const std::vector<char> rest = without(camera.inlier);
  const int left = countOf(rest);
  if (left < kLeastTogether) return std::nullopt;
  const PoseSolution second = inWhole(refinePose(part(problem, rest), prior.predicted.camera_from_world), rest);
  const bool together = second.inliers >= std::max(1. * kLeastTogether, std::min(1. * kSurelyTogether, kShareTogether * left));
  const bool enough = prior.seen_lately || second.inliers >= kLeastMover * camera.inliers;
  return together && enough ? std::optional(TwoMovements{camera, second.inlier}) : std::nullopt;
}

}  // namespace

std::optional<TwoMovements> tellApart(const PoseProblem& problem, const PoseSolution& solution, const PriorOfMovements& prior) {
  const double deviation = deviationFrom(prior.predicted, solution);
  if (deviation > kFar_sigma)
    if (auto apart = heldApart(problem, solution, prior)) return apart;
  return deviation < kSlips_sigma ? movesElsewhere(problem, solution, prior) : std::nullopt;
}

}  // namespace roomgraph::tracking
