// SPDX-License-Identifier: BSD-3-Clause
// Prediction, correlative search, grid refinement and loss handling of the scan matcher.
#include "submap_scan_matcher.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "correlative_search.h"
#include "roomgraph/geometry/covariance.h"
#include "surface_refinement.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(SubmapScanMatcher, ScanMatcher, roomgraph)

namespace {
constexpr int kMatcherLevels = 4;
constexpr double kSteady_s = 0.5, kSlow_s = 2;  // a velocity older than this says nothing; the same of a lidar that is always slow
constexpr double kSharedErrors = 5 * 5;  // variance of matches by what their returns tell: one map errs alike in all of them
constexpr double kAnyVelocity = 0.7, kAnyTurn = 1.2;  // m/s, rad/s, that a movement may differ from the one before
constexpr double kWidest_m = 5;             // half width of a search, however many scans were lost
constexpr double kClearlyBetter = 0.1;     // share of returns that a steady movement must explain more
constexpr double kPause_s = 2, kSamePlace = 0.8;  // after which it is asked whether this is the same place, by the share that is explained
constexpr double kLeastOfNoisy = 0.65;  // share of the returns that the map must explain of a scan much noisier than those before
constexpr double kGridSigma_m = 0.0035, kGridSigma_rad = 0.0012;  // of a match to cells alone

// One map's errors are soon taken for a velocity that goes on; movements that others measured tell them apart.
double sharedErrors(bool measured) { return measured ? 1 : kSharedErrors; }

}  // namespace

void SubmapScanMatcher::declareSearch(ParameterVisitor& v) {
  v.add("window_m", window_m_,
        {.doc = "Half width of the search for the translation around a measured movement.",
         .unit = "m",
         .min = 0,
         .max = 10});
  v.add("window_rad", window_rad_,
        {.doc = "Half width of the search for the rotation around a measured movement.",
         .unit = "rad",
         .min = 0,
         .max = 3.2});
  v.add("free_window_m", free_window_m_,
        {.doc = "Half width of the search for the translation without odometry.",
         .unit = "m",
         .min = 0,
         .max = 10});
  v.add("free_window_rad", free_window_rad_,
        {.doc = "Half width of the search for the rotation without odometry.",
         .unit = "rad",
         .min = 0,
         .max = 3.2});
  v.add("search_penalty_per_m2", search_penalty_per_m2_,
        {.doc = "Score subtracted per squared distance from the prediction.",
         .unit = "1/m^2",
         .min = 0,
         .max = 10000});
  v.add("search_penalty_per_rad2", search_penalty_per_rad2_,
        {.doc = "Score subtracted per squared angle from the prediction.",
         .unit = "1/rad^2",
         .min = 0,
         .max = 10000});
  v.add("prior_per_m2", prior_per_m2_,
        {.doc = "Weight of the prediction against the scan in the refinement, where nothing tells how sure it is: after a loss.",
         .unit = "1/m^2",
         .min = 0,
         .max = 1e+06});
  v.add("prior_per_rad2", prior_per_rad2_,
        {.doc = "Weight of a measured turn against the scan in the refinement.",
         .unit = "1/rad^2",
         .min = 0,
         .max = 1e+06});
  v.add("led", led_,
        {.doc = "A measured movement, or that the robot goes on as it went, counts beside the scan, as sure as it is. no: the scan alone."});
}

void SubmapScanMatcher::declareParameters(ParameterVisitor& v) {
  submap_settings_.declare(v);
  declareSearch(v);
  free_space_options_.declare(v);
  v.add("min_score", min_score_,
        {.doc = "Least share of the returns that the local map must explain.", .min = 0, .max = 1});
  v.add("max_lost_scans", max_lost_scans_,
        {.doc = "Unmatched scans in a row after which a new segment starts.", .min = 0, .max = 10000});
  v.add("covariance_inflation", covariance_inflation_,
        {.doc = "Factor on the standard deviations that the curvature of the match gives.",
         .min = 0.01,
         .max = 100});
  v.add(
      "floor_sigma_m", floor_sigma_m_,
      {.doc = "Least standard deviation of the translation of a match.", .unit = "m", .min = 1e-6, .max = 1});
  v.add(
      "floor_sigma_rad", floor_sigma_rad_,
      {.doc = "Least standard deviation of the rotation of a match.", .unit = "rad", .min = 1e-6, .max = 1});
}

void SubmapScanMatcher::prepare() {
  submaps_ = submap_settings_.emptySubmaps();
  pyramid_stale_ = true;
  free_space_ = FreeSpaceMemory(free_space_options_);
  roughness_ = {};
  own_share_ = {};
  trajectory_ = Trajectory();
  segment_ = lost_scans_ = 0;
  last_t_.reset();
  accepted_t_.reset();
  unled_ = false;
  last_pose_ = kept_pose_ = Pose2();
  place_ = {};
  interval_s_ = 0;
}

ScanMatch SubmapScanMatcher::match(const Scan& scan, const std::optional<Pose2>& previous_from_current) {
  if (!submaps_) prepare();
  const PlanarScan planar = submap_settings_.planar(scan);
  const Points2 points = submap_settings_.points(planar);
  const bool has_prior = previous_from_current.has_value();
  const Pose2 predicted = predict(scan.t, previous_from_current);
  if (last_t_ && scan.t <= *last_t_) {
    ScanMatch repeated;
    repeated.reason = "not after the scan before";
    repeated.odom_from_robot = last_pose_;
    repeated.segment = segment_;
    return repeated;
  }
  unled_ = unled_ || !has_prior;
  const bool steadily = last_t_ && lost_scans_ == 0 && scan.t - *last_t_ <= extrapolated_s();
  if (!has_prior && !steadily) place_ = {};
  if (last_t_) place_.predict(previous_from_current, scan.t - *last_t_, last_pose_.yaw);
  const bool noisy = roughness_.standsOut(scan);
  if (static_cast<int>(points.size()) < submap_settings_.min_points)
    return lose(scan.t, predicted, has_prior, "too few returns");
  if (!submaps_->oldest()) return start(scan, planar, predicted);

  GridRefinement found = matchTo(*submaps_->oldest(), planar, points, predicted,
                                 has_prior ? Led::kByOthers : steadily ? Led::kSteadily : Led::kNot, scan.t - *last_t_);
  if (has_prior && jumps(scan.t, predicted)) {
    const GridRefinement steady = matchTo(*submaps_->oldest(), planar, points, steadyPose(scan.t), Led::kNot);
    if (steady.explained > found.explained + kClearlyBetter) found = steady, found.trust = 0;
  }
  if (noisy && has_prior && found.explained < kLeastOfNoisy) return ledOver(scan.t, predicted, "much noisier than the scans before");
  // Recording may have paused while the robot was carried off.
  const bool elsewhere = accepted_t_ && scan.t - *accepted_t_ > kPause_s && unled_ && found.explained < kSamePlace;
  if (found.explained < min_score_ || elsewhere) {
    if (!elsewhere && lost_scans_ < max_lost_scans_) return lose(scan.t, predicted, has_prior, "no overlap");
    ++segment_;
    submaps_->finishAll();
    free_space_.clear();
    const bool anywhere = unled_;
    ScanMatch begun = start(scan, planar, predicted);
    begun.anywhere = anywhere;
    return begun;
  }
  ScanMatch out;
  out.matched = true;
  out.odom_from_robot = found.grid_from_scan;
  out.segment = segment_;
  out.score = found.explained;
  out.step_covariance = stepCovariance(found);
  if (lost_scans_ == 0) {
    const double variance = std::max(1e-6, found.residual_variance) * (found.on_surfaces ? sharedErrors(has_prior) : kSharedErrors);
    place_.update(last_pose_.inverse() * found.grid_from_scan, placeCurvature(found.curvature) / variance, found.trust);
  } else {
    place_ = {};
  }
  out.moving = accept(scan, planar, found.grid_from_scan);
  return out;
}

Pose2 SubmapScanMatcher::predict(double t, const std::optional<Pose2>& previous_from_current) const {
  if (!last_t_) return {};
  return previous_from_current ? last_pose_ * place_.corrected(*previous_from_current) : steadyPose(t);
}

Pose2 SubmapScanMatcher::steadyPose(double t) const {
  const double dt = t - *last_t_;
  return dt > extrapolated_s() ? last_pose_ : last_pose_ * place_.steadyStep(dt);
}

// Where scans come further apart for once, the robot may have stood meanwhile: some record nothing then.
double SubmapScanMatcher::extrapolated_s() const {
  constexpr double kAsUsual = 1.5;
  return std::clamp(kAsUsual * interval_s_, kSteady_s, kSlow_s);
}

bool SubmapScanMatcher::jumps(double t, const Pose2& predicted) const {
  if (lost_scans_ > 0 || t - *last_t_ > kSteady_s) return false;
  const Pose2 jump = steadyPose(t).inverse() * predicted;
  return std::hypot(jump.x, jump.y) > window_m_ || std::abs(jump.yaw) > window_rad_;
}

GridRefinement SubmapScanMatcher::matchTo(const Submap& submap, const PlanarScan& planar, const Points2& points,
                                          const Pose2& predicted, Led led, double since_s) {
  const bool has_prior = led == Led::kByOthers;
  if (pyramid_stale_) pyramid_ = ScorePyramid(submap.grid, kMatcherLevels);
  pyramid_stale_ = false;
  SearchWindow window;
  // After a loss the prediction is as old as the loss: look wider for each scan missed.
  const double widening = 1 + std::min(lost_scans_, max_lost_scans_);
  window.linear_m = std::min(kWidest_m, widening * (has_prior ? window_m_ : std::max(free_window_m_, kAnyVelocity * since_s)));
  window.angular_rad = std::min(std::numbers::pi, widening * (has_prior ? window_rad_ : std::max(free_window_rad_, kAnyTurn * since_s)));
  const double trust = has_prior ? 1 : 0.2;
  window.penalty_per_m2 = trust * search_penalty_per_m2_;
  window.penalty_per_rad2 = trust * search_penalty_per_rad2_;
  const auto coarse = correlativeSearch(pyramid_, points, predicted, window);
  const Pose2 start_pose = coarse ? coarse->grid_from_scan : predicted;
  PosePrior prior{predicted, trust * prior_per_m2_, trust * prior_per_rad2_};
  Eigen::Matrix2d led_by = Eigen::Matrix2d::Zero();  // in units of what the returns tell
  if (led_ && led != Led::kNot) {
    led_by = sharedErrors(has_prior) * place_.covariance().inverse();
    const double residual = gridCost(submap.grid, points, start_pose, {}).residual;
    prior.extra_weight_per_m2 = residual / static_cast<double>(points.size()) * led_by;
    prior.weight_per_m2 = 0;
  }
  GridRefinement fine = refineOnGrid(submap.grid, points, start_pose, prior);
  prior.extra_weight_per_m2.setZero();
  prior.information_per_m2 = led_by;
  prior.may_slip = has_prior;
  refineFurther(submap.surfaces, faced(planar), prior, own_share_, fine);
  return fine;
}

Eigen::Matrix3d SubmapScanMatcher::stepCovariance(const GridRefinement& refinement) const {
  CovarianceModel model;
  model.inflation = covariance_inflation_;
  model.floor_sigma_m = std::hypot(floor_sigma_m_, refinement.on_surfaces ? 0 : kGridSigma_m);
  model.floor_sigma_rad = std::hypot(floor_sigma_rad_, refinement.on_surfaces ? 0 : kGridSigma_rad);
  const Eigen::Matrix3d in_odom = poseCovariance(refinement, model);
  // Movement is expressed in the frame of the robot at the scan before.
  return rotateCovariance(in_odom, -last_pose_.yaw);
}

std::vector<std::size_t> SubmapScanMatcher::accept(const Scan& scan, const PlanarScan& planar, const Pose2& pose) {
  interval_s_ = last_t_ ? scan.t - *last_t_ : 0;
  last_t_ = accepted_t_ = scan.t;
  last_pose_ = pose;
  unled_ = false;
  lost_scans_ = 0;
  trajectory_.add(scan.t, toPose3(pose), segment_);
  std::vector<std::size_t> moving;
  if (free_space_options_.enabled) moving = free_space_.observe(scan, pose, submap_settings_.min_range_m);
  const MotionFilter filter = submap_settings_.filter();
  if (submaps_->oldest() && !filter.moved(kept_t_, kept_pose_, scan.t, pose)) return moving;
  kept_t_ = scan.t;
  kept_pose_ = pose;
  submaps_->insert(planar, pose);
  pyramid_stale_ = true;
  return moving;
}

ScanMatch SubmapScanMatcher::start(const Scan& scan, const PlanarScan& planar, const Pose2& pose) {
  place_ = {};
  lost_scans_ = 1;  // no movement can be derived from what came before
  accept(scan, planar, pose);
  ScanMatch out;
  out.matched = true;
  out.odom_from_robot = pose;
  out.segment = segment_;
  out.score = 1;
  // The map begins with this scan: its place in it is only as unsure as any match.
  out.step_covariance =
      Eigen::Vector3d(floor_sigma_m_, floor_sigma_m_, floor_sigma_rad_).cwiseAbs2().asDiagonal();
  return out;
}

ScanMatch SubmapScanMatcher::lose(double t, const Pose2& predicted, bool has_prior, std::string reason) {
  ++lost_scans_;
  if (!has_prior) place_ = {};
  return ledOver(t, predicted, std::move(reason));
}

ScanMatch SubmapScanMatcher::ledOver(double t, const Pose2& predicted, std::string reason) {
  if (last_t_) {
    last_t_ = t;
    last_pose_ = predicted;
  }
  ScanMatch out;
  out.reason = std::move(reason);
  out.odom_from_robot = predicted;
  out.segment = segment_;
  return out;
}

}  // namespace roomgraph
