// SPDX-License-Identifier: BSD-3-Clause
// A second solution from the prediction, and how far both are from it in the image.
#include "two_movements.h"

#include <algorithm>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph::tracking {
namespace {

constexpr int kLeastTogether = 10;      // observations of a second movement
constexpr int kLeastWithout = 30;       // where no other sensor measured the first one: a velocity does not tell much
constexpr double kShareTogether = 0.6;  // of what the first one leaves out,
constexpr int kSurelyTogether = 20;     // or so many: of wrong matches no more than 13 were seen to agree
constexpr double kEnough = 0.5;         // of the observations of the first one, if the prediction has so many
constexpr double kLeastMover = 0.2;     // of them, where the first movement is the camera's
constexpr double kMoves_px = 3;         // from where it was predicted, by the first movement,
constexpr double kNearer = 0.5;         // and by the second one, as a share of that

// How far the points lie apart in the image by two poses: the median.
double pixelsApart(const PoseProblem& problem, const PoseSolution& solution, const Pose3& camera_from_world) {
  std::vector<double> pixels;
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    const Eigen::Vector3d a = solution.camera_from_world * problem.points[i], b = camera_from_world * problem.points[i];
    if (solution.inlier[i] && a.z() > 0 && b.z() > 0) pixels.push_back((problem.camera.project(a) - problem.camera.project(b)).norm());
  }
  return pixels.empty() ? 0 : median(std::move(pixels));
}

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

std::vector<char> onlyIn(const PoseSolution& one, const PoseSolution& other) {
  std::vector<char> out;
  for (std::size_t i = 0; i < one.inlier.size(); ++i) out.push_back(one.inlier[i] && !other.inlier[i]);
  return out;
}

}  // namespace

std::optional<TwoMovements> tellApart(const PoseProblem& problem, const PoseSolution& solution, const Pose3& predicted_camera_from_world,
                                      const PriorOfMovements& prior) {
  const auto leftBy = [&](const PoseSolution& one) { return static_cast<int>(problem.points.size()) - one.inliers; };
  const auto apartOf = [&](const PoseSolution& one) { return pixelsApart(problem, one, predicted_camera_from_world); };
  if (apartOf(solution) < kMoves_px && leftBy(solution) < kLeastTogether) return std::nullopt;
  const PoseSolution near = refinePose(problem, predicted_camera_from_world, true);
  // With all of two movements one may come to rest between them.
  const PoseSolution& first = near.inliers > solution.inliers ? near : solution;
  const int left = leftBy(first);
  const std::vector<char> rest = without(first.inlier);
  const PoseSolution second = inWhole(refinePose(part(problem, rest), predicted_camera_from_world), rest);
  const bool together = second.inliers >= std::max(1. * kLeastTogether, std::min(1. * kSurelyTogether, kShareTogether * left));
  const double apart_px = apartOf(first);
  if (apart_px < kMoves_px)
    return together && (prior.seen_lately || second.inliers >= kLeastMover * first.inliers) ? std::optional(TwoMovements{first, second.inlier}) : std::nullopt;
  const int least = prior.measured ? kLeastTogether : kLeastWithout;
  if (together && second.inliers >= least && apartOf(second) < kNearer * apart_px) {
    const PoseSolution camera = refinePose(problem, second.camera_from_world, true);  // some went with the first one as well
    return TwoMovements{camera, onlyIn(first, camera)};
  }
  if (near.inliers >= std::max(1. * least, kEnough * first.inliers) && apartOf(near) < kNearer * apart_px)
    return TwoMovements{near, onlyIn(first, near)};
  return std::nullopt;
}

}  // namespace roomgraph::tracking
