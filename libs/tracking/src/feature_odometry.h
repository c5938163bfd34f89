// SPDX-License-Identifier: BSD-3-Clause
// Feature-based RGB-D odometry: keyframes, local map, relocalisation, loop closures.
#pragma once

#include <memory>

#include "roomgraph/tracking/rgbd_odometry.h"
#include "tracking_parameters.h"

namespace roomgraph {

namespace tracking {
class Tracker;
}

/// Sparse RGB-D odometry in the manner of ORB-SLAM2 (Mur-Artal & Tardos, T-RO 2017): ORB features with depth,
/// a local map of points held by keyframes, windowed bundle adjustment, relocalisation, and loop closures as
/// measurements (the back end, not the tracker, corrects drift with them). Deterministic; features can be found on another
/// thread.
class FeatureOdometry : public RgbdOdometry {
  DEFINE_MRPT_OBJECT(FeatureOdometry, roomgraph)
 public:
  FeatureOdometry();
  ~FeatureOdometry() override;

  void declareParameters(ParameterVisitor& visitor) override { parameters_.declareParameters(visitor); }
  /// Forgets everything tracked so far; called by itself before the first frame.
  void prepare() override;
  /// What was found of frames between keyframes, and local bundle adjustments, are kept there.
  void setResultStore(ResultStore& store) override;
  TrackingResult track(const Frame& frame, const TrackingPrior& prior) override;
  void foresee(const Frame& frame) override;
  Trajectory trajectory() const override;
  std::vector<RelativePose> takeLoopClosures() override;
  std::optional<RelativePose> verifyLoop(const RelativePose& proposed) override;
  void release() override;

 private:
  TrackingParameters parameters_;
  std::unique_ptr<tracking::Tracker> tracker_;
};

}  // namespace roomgraph
