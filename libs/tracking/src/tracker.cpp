// SPDX-License-Identifier: BSD-3-Clause
// Main loop of the tracker: start, loss, keyframes, step covariance.
#include "tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "bundle_adjustment.h"
#include "keyframe_insertion.h"
#include "place_recognition.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/result_store.h"
#include "roomgraph/geometry/covariance.h"
#include "roomgraph/observations/mounting.h"
#include "view_bytes.h"

namespace roomgraph::tracking {
namespace {

constexpr int kCoastFrames = 3;         // lost frames over which the velocity is extrapolated
constexpr double kMissing = 1.5;         // times the step before: an image is missing; less is how stamps vary at a steady rate
constexpr double kLongestStep_s = 0.25;  // over which a velocity goes on
constexpr double kLongestGap_s = 1000;   // before the first frame there is none
constexpr double kUntoldPause_s = 2;    // without a frame, in which a camera may be carried away

/// Why a frame cannot be used at all; empty when it can.
std::string unusable(const Frame& frame, double last_t) {
  if (frame.gray.empty() && frame.color.empty()) return "no image";
  if (!frame.hasDepth()) return "no depth";
  if (!frame.camera.valid()) return "no camera parameters";
  if (frame.t <= last_t) return "time stamp not after the last frame's";
  return "";
}

cv::Mat grayOf(const Frame& frame) {
  if (!frame.gray.empty()) return frame.gray;
  cv::Mat gray;
  cv::cvtColor(frame.color, gray, cv::COLOR_BGR2GRAY);
  return gray;
}

}  // namespace

Matrix6d floorCovariance(double sigma_m, double sigma_rad) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m);
  covariance.diagonal().tail<3>().setConstant(sigma_rad * sigma_rad);
  return covariance;
}

Pose3 Tracker::lastPose() const {
  return map_.keyframe(placed_.keyframe).odom_from_camera * placed_.keyframe_from_camera;
}

Pose3 Tracker::goesOn() const {
  if (!velocity_ || velocity_->seconds <= 0) return Pose3::Identity();
  const double as_before = step_s_ / velocity_->seconds;
  if (as_before > 1 / kMissing && as_before < kMissing) return velocity_->step;
  return interpolate(Pose3::Identity(), velocity_->step, std::min(step_s_, kLongestStep_s) / velocity_->seconds);
}

TrackingResult Tracker::track(const Frame& frame, const TrackingPrior& by_others) {
  const TrackingPrior prior = withMovers(by_others, frame.t);
  // Without other sensors the last velocity is trusted for a moment only.
  robot_from_camera_ = isMounted(frame) ? std::optional(frame.robot_from_camera) : std::nullopt;
  const bool goes_on = blind_frames_ < kCoastFrames || (parameters_.dense_alignment && dense_.unbroken(frame.t));
  step_s_ = std::clamp(frame.t - reckoned_t_, 0.0, kLongestGap_s);
  reckoned_t_ = std::max(reckoned_t_, frame.t);
  const Pose3 guess = goes_on ? goesOn() : Pose3::Identity();
  carried_ |= !records_.empty() && frame.t - last_t_ > kUntoldPause_s && !prior.previous_from_current;
  dead_reckoned_before_ = dead_reckoned_;
  dead_reckoned_ = normalized(dead_reckoned_ * prior.previous_from_current.value_or(expected(guess)));
  measured_ = measured_ && prior.previous_from_current ? std::optional(normalized(*measured_ * *prior.previous_from_current)) : std::nullopt;
  if (const auto reason = unusable(frame, last_t_); !reason.empty()) return lost(reason, nullptr);
  last_t_ = frame.t;
  const auto known = results_ ? results_->recall("view", frame.t) : std::nullopt;
  keeps_view_ = results_ && !known;
  densely_placed_ = false;
  TrackingResult result = known && !known->empty() ? recall(frame, prior, *known) : look(frame, prior);
  if (result.tracked)
    learnHabits(frame.t);
  else
    habit_from_.reset();
  if (!parameters_.dense_alignment) return result;
  if (result.tracked)
    dense_.begin(frame, withMovers(by_others, frame.t).dynamic_regions, velocity_.has_value());
  else
    acceptDense(frame, result);
  return result;
}

void Tracker::foresee(const Frame& frame) {
  if ((results_ && results_->recalling()) || !unusable(frame, -std::numeric_limits<double>::infinity()).empty())
    return;
  Sight sight{grayOf(frame), {}, {}};
  sight.corners = findCorners(sight.gray, parameters_);
  sight.features = extractFeatures(sight.gray, sight.corners, frame, {}, parameters_);
  foreseen_.put(frame.t, std::move(sight));
}

void Tracker::see(View& view, const std::vector<Box2>& excluded) {
  auto sight = foreseen_.take(view.frame->t);
  view.gray = sight ? sight->gray : grayOf(*view.frame);
  if (sight && excluded.empty())
    view.features = std::move(sight->features);
  else
    view.features = extractFeatures(view.gray, sight ? sight->corners : findCorners(view.gray, parameters_),
                                    *view.frame, excluded, parameters_);
}

TrackingResult Tracker::look(const Frame& frame, const TrackingPrior& prior) {
  View view;
  view.frame = &frame;
  view.prior = &prior;
  see(view, prior.dynamic_regions);
  view.points.assign(view.features.size(), -1);
  const auto with_depth = view.features.withDepth();
  if (with_depth < parameters_.min_inliers) {
    keep(nullptr);
    alignDensely(frame, prior);
    return lost(with_depth == 0 && view.features.size() > 0 ? "no depth" : "too few features", nullptr);
  }
  const Pose3 previous = reference_ < 0 ? Pose3::Identity() : lastPose();
  view.odom_from_camera = previous * dead_reckoned_;
  if (reference_ >= 0 && findPose(view, previous)) return accept(view, previous);
  keep(nullptr);
  return reference_ < 0 ? start(std::move(view)) : lost("too few inliers", &view);
}

// A view of another map would lead out of this one.
void Tracker::requireKnown(const LocatedView& kept) const {
  const auto known = [&](std::int64_t id) { return id < static_cast<std::int64_t>(map_.points.size()); };
  if (kept.reference < 0 || kept.reference >= static_cast<int>(map_.keyframes.size()) ||
      !std::all_of(kept.points.begin(), kept.points.end(), known) ||
      !std::all_of(kept.in_view.begin(), kept.in_view.end(), known) ||
      map_.keyframe(kept.reference).origin != map_.keyframe(placed_.keyframe).origin)
    throw InputError("checkpoint: its view of second " + std::to_string(last_t_) + " shows what is not in the map");
}

TrackingResult Tracker::recall(const Frame& frame, const TrackingPrior& prior, const std::string& bytes) {
  LocatedView kept = decodedResult("view", last_t_, bytes, locatedView);
  requireKnown(kept);
  View view{.frame = &frame,
            .prior = &prior,
            .features = std::move(kept.features),
            .points = std::move(kept.points),
            .in_view = std::move(kept.in_view),
            .odom_from_camera = kept.odom_from_camera,
            .matches = kept.matches};
  view.solution.inliers = kept.inliers;
  view.solution.covariance = kept.covariance;
  count(view);
  reference_ = kept.reference;
  reference_inliers_ = kept.reference_inliers;
  return accept(view, lastPose());
}

void Tracker::keep(const View* view) {
  if (!keeps_view_) return;
  LocatedView kept;
  for (std::size_t i = 0; view && i < view->points.size(); ++i) {
    if (view->points[i] < 0) continue;
    kept.features.places.push_back(view->features.places[i]);
    kept.features.depth.push_back(view->features.depth[i]);
    kept.points.push_back(view->points[i]);
  }
  if (view) {
    kept.in_view = view->in_view;
    kept.odom_from_camera = view->odom_from_camera;
    kept.covariance = view->solution.covariance;
    kept.inliers = view->solution.inliers;
    kept.matches = view->matches;
    kept.reference = reference_;
    kept.reference_inliers = reference_inliers_;
  }
  results_->keep("view", last_t_, view ? bytesOf(kept) : "");
}

TrackingResult Tracker::start(View view) {
  TrackingResult result;
  if (!records_.empty()) {
    linkSegments(view.frame->t);
    view.odom_from_camera = lastPose() * dead_reckoned_;
    ++segment_;
  }
  view.points.assign(view.features.size(), -1);
  addKeyframe(view, static_cast<int>(map_.keyframes.size()));
  records_.push_back({view.frame->t, reference_, Pose3::Identity(), segment_});
  placed_ = records_.back();
  if (!densely_placed_) velocity_.reset();
  habit_from_.reset();
  dead_reckoned_ = Pose3::Identity();
  measured_ = Pose3::Identity();
  lost_frames_ = blind_frames_ = 0;
  carried_ = false;
  last_covariance_.setZero();
  result.keyframe = true;
  result.inliers = result.matches = static_cast<int>(last_points_.size());
  report(view.features, map_.keyframe(reference_).points, result);
  return result;
}

TrackingResult Tracker::lost(const std::string& reason, View* view) {
  ++blind_frames_;
  if (++lost_frames_ > parameters_.relocalisation_frames && view && view->moving == 0 && !ledPastMover(view->frame->t) && reference_ >= 0)
    return start(std::move(*view));
  TrackingResult result;
  result.reason = reason;
  result.segment = segment_;
  if (!records_.empty()) result.odom_from_camera = lastPose() * dead_reckoned_;
  if (view) {
    result.matches = view->matches;
    result.moving = view->moving;
  }
  return result;
}

TrackingResult Tracker::accept(const View& view, const Pose3& previous) {
  const Pose3 step = normalized(previous.inverse() * view.odom_from_camera);
  // After frames that dense alignment placed a step corrects its drift, too: their own velocity holds.
  if (lost_frames_ == 0) velocity_ = {normalized((previous * dead_reckoned_before_).inverse() * view.odom_from_camera), step_s_};
  TrackingResult result;
  result.step_covariance = stepCovariance(step, view.solution);
  const bool elsewhere = view.jumped || map_.keyframe(reference_).origin != map_.keyframe(placed_.keyframe).origin;
  if (elsewhere) {
    goElsewhere(view);
    result.reason = "found again in another place";
    result.step_covariance = Matrix6d::Identity();  // no step leads there
  }
  // A step over several frames, a pause, or between segments says nothing about the next one.
  if (blind_frames_ > 0 || carried_ || elsewhere) {
    velocity_.reset();
    habit_from_.reset();
  }
  dead_reckoned_ = Pose3::Identity();
  measured_ = Pose3::Identity();
  lost_frames_ = blind_frames_ = 0;
  carried_ = false;
  result.inliers = view.solution.inliers;
  result.matches = view.matches;
  result.moving = view.moving;
  if (reference_inliers_ == 0) reference_inliers_ = view.solution.inliers;
  last_points_.clear();
  for (const auto id : view.points)
    if (id >= 0) last_points_.push_back(id);
  result.keyframe = view.moving == 0 && needsKeyframe(view);  // the next one leaves out what moves
  keep(result.keyframe || elsewhere || view.moving > 0 ? nullptr : &view);
  if (result.keyframe) addKeyframe(view, map_.keyframe(reference_).origin);
  records_.push_back({view.frame->t, reference_,
                      result.keyframe
                          ? Pose3::Identity()
                          : map_.keyframe(reference_).odom_from_camera.inverse() * view.odom_from_camera,
                      segment_});
  placed_ = records_.back();
  report(view.features, result.keyframe ? map_.keyframe(reference_).points : view.points, result);
  return result;
}

void Tracker::goElsewhere(const View& view) {
  if (!view.prior->previous_from_current) linkSegments(view.frame->t);
  const Pose3 reference_from_view = map_.keyframe(reference_).odom_from_camera.inverse() * view.odom_from_camera;
  RelativePose closure = loopOf(reference_, view.frame->t, reference_from_view, view.solution.covariance);
  closure.rival_m = nearestRival_m(reference_, {view.features, view.frame->camera, makeThumbnail(view.gray)}, reference_from_view, view.solution.inliers);
  closures_.push_back(std::move(closure));
  ++segment_;
}

void Tracker::report(const Features& features, const std::vector<std::int64_t>& points,
                     TrackingResult& result) const {
  result.tracked = true;
  result.segment = segment_;
  result.odom_from_camera = lastPose();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i] >= 0) result.features.push_back({features.pixel(i), points[i], features.depth[i]});
}

bool Tracker::needsKeyframe(const View& view) const {
  const Pose3 moved = map_.keyframe(reference_).odom_from_camera.inverse() * view.odom_from_camera;
  return view.solution.inliers < parameters_.keyframe_inlier_ratio * reference_inliers_ ||
         moved.translation().norm() > parameters_.keyframe_distance_m ||
         rotationAngle(moved) > parameters_.keyframe_angle_rad;
}

void Tracker::addKeyframe(const View& view, int origin) {
  Keyframe keyframe{.t = view.frame->t,
                    .segment = segment_,
                    .origin = origin,
                    .camera = view.frame->camera,
                    .odom_from_camera = view.odom_from_camera,
                    .features = view.features,
                    .points = view.points,
                    .thumbnail = makeThumbnail(view.gray),
                    .sketch = sketchDepth(*view.frame, view.prior->dynamic_regions)};
  reference_ = insertKeyframe(map_, std::move(keyframe), parameters_);
  reference_inliers_ = 0;
  adjustLocally(map_, reference_, parameters_, results_);
  last_points_.clear();
  for (const auto id : map_.keyframe(reference_).points)
    if (id >= 0) last_points_.push_back(id);
  closeLoops(reference_);
  giveUpRepeated();
}

Matrix6d Tracker::stepCovariance(const Pose3& previous_from_current, const PoseSolution& solution) {
  // Both ends of the step were located in the map with an error of their own.
  const Matrix6d sum =
      rotateCovariance(solution.covariance, previous_from_current.linear()) + last_covariance_;
  last_covariance_ = solution.covariance;
  return parameters_.covariance_scale * sum +
         floorCovariance(parameters_.min_step_sigma_m, parameters_.min_step_sigma_rad);
}

Trajectory Tracker::trajectory() const {
  Trajectory out;
  for (const auto& record : records_) {
    const Keyframe& keyframe = map_.keyframe(record.keyframe);
    out.add(record.t, normalized(keyframe.odom_from_camera * record.keyframe_from_camera), record.segment);
  }
  return out;
}

}  // namespace roomgraph::tracking
