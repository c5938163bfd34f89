// SPDX-License-Identifier: BSD-3-Clause
// Views before which something moves: its points are given up, and where it is nothing is used for a while.
#include "roomgraph/core/order_statistics.h"
#include "tracker.h"
#include "two_movements.h"

namespace roomgraph::tracking {
namespace {

constexpr double kLately_s = 10;      // it may come again
constexpr double kLasts_s = 0.5;      // where something moved nothing is used for so long
constexpr double kAround = 0.1;       // of its size
constexpr double kOutermost = 0.05;   // share of features that may be mismatches

}  // namespace

bool Tracker::solveWithMovers(View& view, const Pose3& predicted) {
  std::vector<std::size_t> used, moving;
  const auto matched = view.points;
  const PoseProblem problem = problemOf(view, used);
  // Half of what was matched must agree, otherwise the prediction was wrong.
  if (!solve(view, parameters_.min_inliers, false)) return false;
  const bool is_most = view.solution.inliers > view.matches / 2;
  const auto two = tellApart(problem, view.solution, predicted.inverse(),
                             {.measured = view.prior->previous_from_current.has_value(), .seen_lately = view.frame->t - mover_t_ < kLately_s});
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

TrackingPrior Tracker::withMovers(const TrackingPrior& prior, double t) const {
  TrackingPrior out = prior;
  if (t - mover_t_ < kLasts_s) out.dynamic_regions.push_back(mover_);
  return out;
}

}  // namespace roomgraph::tracking
