// SPDX-License-Identifier: BSD-3-Clause
// Views before which something moves: its points are given up, and where it is nothing is used for a while.
#include "roomgraph/core/order_statistics.h"
#include "tracker.h"
#include "two_movements.h"

namespace roomgraph::tracking {
namespace {

constexpr double kMeasured_m = 0.005, kMeasured_rad = 0.003, kMeasuredShare = 0.1;                  // standard deviations of a measured movement,
constexpr double kVelocity_m = 0.01, kVelocity_rad = 0.01, kVelocityShare = 0.3;  // and of one that is taken to go on
constexpr double kLately_s = 10;      // it may come again
constexpr double kFollows_s = 2, kFollows_sigma = 5;  // so long a view so far from the measured one may be placed by it
constexpr double kLasts_s = 0.5;      // where something moved nothing is used for so long
constexpr double kAround = 0.1;       // of its size
constexpr double kOutermost = 0.05;   // share of features that may be mismatches

// Wheels and scans err by shares of a movement, and by their clocks; a velocity changes.
PosePrior predictedBy(const Pose3& odom_from_camera, const Pose3& movement, bool measured) {
  const double share = measured ? kMeasuredShare : kVelocityShare;
  return {odom_from_camera.inverse(), (measured ? kMeasured_m : kVelocity_m) + share * movement.translation().norm(),
          (measured ? kMeasured_rad : kVelocity_rad) + share * rotationAngle(movement)};
}

}  // namespace

std::optional<PosePrior> Tracker::measuredPose() const {
  if (!measured_) return std::nullopt;
  return predictedBy(lastPose() * *measured_, *measured_, true);
}

bool Tracker::ledPastMover(double t) const { return measured_ && t - mover_t_ < kFollows_s; }

bool Tracker::followsMover(const View& view) const {
  return ledPastMover(view.frame->t) && deviationFrom(*measuredPose(), view.solution) > kFollows_sigma;
}

bool Tracker::solveWithMovers(View& view, const Pose3& predicted) {
  std::vector<std::size_t> used, moving;
  const auto matched = view.points;
  const PoseProblem problem = problemOf(view, used);
  // Half of what was matched must agree, otherwise the prediction was wrong.
  if (!solve(view, parameters_.min_inliers, false)) return false;
  const bool is_most = view.solution.inliers > view.matches / 2;
  const auto measured = measuredPose();
  const auto two = tellApart(problem, view.solution, {.predicted = measured ? *measured : predictedBy(predicted, dead_reckoned_, false),
                                                      .measured = measured.has_value(),
                                                      .seen_lately = view.frame->t - mover_t_ < kLately_s});
  if (!two) return is_most;
  for (std::size_t j = 0; j < used.size(); ++j) {
    view.points[used[j]] = two->camera.inlier[j] ? matched[used[j]] : -1;
    if (!two->moving[j]) continue;
    moving.push_back(used[j]);
    map_.erase(matched[used[j]]);
  }
  giveUpMoving(view, moving);
  view.solution = two->camera;
  view.odom_from_camera = normalized(two->camera.camera_from_world.inverse());
  return view.solution.inliers >= parameters_.min_inliers;
}

void Tracker::giveUpMoving(View& view, const std::vector<std::size_t>& features) {
  std::vector<double> u, v;
  for (const std::size_t i : features) {
    u.push_back(view.features.pixel(i).x());
    v.push_back(view.features.pixel(i).y());
  }
  view.moving = static_cast<int>(u.size());
  mover_t_ = view.frame->t;
  mover_ = {quantile(u, kOutermost), quantile(v, kOutermost), quantile(u, 1 - kOutermost), quantile(v, 1 - kOutermost)};
  const double aside = kAround * mover_.width(), above = kAround * mover_.height();
  mover_ = {mover_.u_min - aside, mover_.v_min - above, mover_.u_max + aside, mover_.v_max + above};
}

void Tracker::leaveOutMover(View& view, std::vector<PointMatch>& matches) const {
  if (view.moving == 0) return;
  std::erase_if(matches, [&](const PointMatch& match) {
    const auto pixel = view.features.pixel(static_cast<std::size_t>(match.feature));
    if (!mover_.contains(pixel.x(), pixel.y())) return false;
    std::erase(view.in_view, match.point);
    return true;
  });
}

TrackingPrior Tracker::withMovers(const TrackingPrior& prior, double t) const {
  TrackingPrior out = prior;
  if (t - mover_t_ < kLasts_s) out.dynamic_regions.push_back(mover_);
  return out;
}

}  // namespace roomgraph::tracking
