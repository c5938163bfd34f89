// SPDX-License-Identifier: BSD-3-Clause
// Frames that features do not place: by dense alignment since the last one that they did.
#include <cmath>

#include "roomgraph/geometry/covariance.h"
#include "tracker.h"

namespace roomgraph::tracking {
namespace {
constexpr double kGoesOn = 0.6;  // share of a velocity that is taken to be left after a second
constexpr double kLearnt_m = 0.15, kLearnt_rad = 0.3, kLongest_s = 6;  // of movements that habits are learnt from
}  // namespace

void Tracker::learnHabits(double t) {
  if (!robot_from_camera_) return;
  const Pose3 odom_from_camera = lastPose();
  if (!habit_from_ || t - habit_from_->t > kLongest_s) {
    habit_from_ = StampedPose{t, odom_from_camera};
    return;
  }
  const Pose3 moved = habit_from_->pose.inverse() * odom_from_camera;
  if (moved.translation().norm() < kLearnt_m && rotationAngle(moved) < kLearnt_rad) return;
  habits_.learn(*robot_from_camera_ * moved * robot_from_camera_->inverse(), t - habit_from_->t);
  habit_from_ = StampedPose{t, odom_from_camera};
}

Pose3 Tracker::expected(const Pose3& step) const {
  if (!robot_from_camera_) return step;
  return robot_from_camera_->inverse() * habits_.expected(*robot_from_camera_ * step * robot_from_camera_->inverse()) *
         *robot_from_camera_;
}

bool Tracker::alignDensely(const Frame& frame, const TrackingPrior& prior) {
  // Tried beside scans, too: no better in three flats, worse in one (docs/results.md).
  if (!parameters_.dense_alignment || prior.by_scans) return false;
  DenseChain::Prediction predicted{.first_from_current = dead_reckoned_, .measured = prior.previous_from_current.has_value(),
                                   .sigma_m = prior.sigma_m, .sigma_rad = prior.sigma_rad};
  if (predicted.measured && velocity_) predicted.otherwise = dead_reckoned_before_ * expected(goesOn());
  if (robot_from_camera_) predicted.body = CarryingBody{robot_from_camera_->inverse(), habits_.scatter()};
  const auto moved = dense_.follow(frame, prior.dynamic_regions, predicted);
  densely_placed_ = moved.has_value();
  if (moved) dead_reckoned_ = moved->first_from_current;
  return densely_placed_;
}

void Tracker::acceptDense(const Frame& frame, TrackingResult& result) {
  if (!densely_placed_) return;
  records_.push_back({frame.t, placed_.keyframe, placed_.keyframe_from_camera * dead_reckoned_, placed_.segment});
  result.tracked = dense_.last().seen;
  result.predicted = !result.tracked;
  if (result.tracked) {
    result.reason = "by depth and brightness: " + result.reason;
    blind_frames_ = 0;
    // Where nothing is seen of a movement, it ends rather than goes on.
    velocity_ = {interpolate(Pose3::Identity(), normalized(dead_reckoned_before_.inverse() * dead_reckoned_), std::pow(kGoesOn, step_s_)), step_s_};
  }
  result.segment = placed_.segment;
  result.odom_from_camera = lastPose() * dead_reckoned_;
  // The movement is told in the first frame's axes, an error of a match in the camera's.
  result.step_covariance =
      rotateCovariance(dense_.last().covariance, dead_reckoned_.linear().transpose());
}

void Tracker::linkSegments(double t) {
  if (!densely_placed_) return;
  closures_.push_back({.t_a = placed_.t,
                       .t_b = t,
                       .a_from_b = dead_reckoned_,
                       .covariance = dense_.last().covariance,
                       .source = "dense alignment",
                       .link = true});
}

}  // namespace roomgraph::tracking
