// SPDX-License-Identifier: BSD-3-Clause
// FeatureOdometry delegating to its Tracker.
#include "feature_odometry.h"

#include "tracker.h"

IMPLEMENTS_MRPT_OBJECT(FeatureOdometry, RgbdOdometry, roomgraph)

namespace roomgraph {

FeatureOdometry::FeatureOdometry() = default;
FeatureOdometry::~FeatureOdometry() = default;

void FeatureOdometry::prepare() {
  tracker_ = std::make_unique<tracking::Tracker>(parameters_);
}

void FeatureOdometry::setResultStore(ResultStore& store) {
  if (!tracker_) prepare();
  tracker_->setResultStore(store);
}

TrackingResult FeatureOdometry::track(const Frame& frame, const TrackingPrior& prior) {
  if (!tracker_) prepare();
  return tracker_->track(frame, prior);
}

void FeatureOdometry::foresee(const Frame& frame) {
  if (tracker_) tracker_->foresee(frame);
}

Trajectory FeatureOdometry::trajectory() const {
  return tracker_ ? tracker_->trajectory() : Trajectory();
}

std::optional<RelativePose> FeatureOdometry::verifyLoop(const RelativePose& proposed) {
  return tracker_ ? tracker_->verifyLoop(proposed) : std::nullopt;
}

std::vector<RelativePose> FeatureOdometry::takeLoopClosures() {
  return tracker_ ? tracker_->takeLoopClosures() : std::vector<RelativePose>();
}

void FeatureOdometry::release() {
  tracker_.reset();
}

}  // namespace roomgraph
