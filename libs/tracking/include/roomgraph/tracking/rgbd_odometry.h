// SPDX-License-Identifier: BSD-3-Clause
// Interface of RGB-D visual odometry.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/core/stage.h"
#include "roomgraph/geometry/box.h"
#include "roomgraph/observations/feature_track.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// What is known before a frame is tracked.
struct TrackingPrior {
  /// Movement of the camera since the last frame as other sensors saw it; nothing when there are none.
  std::optional<Pose3> previous_from_current;
  /// Standard deviations of that movement, m and rad; infinity: not known.
  double sigma_m = std::numeric_limits<double>::infinity(), sigma_rad = std::numeric_limits<double>::infinity();
  /// That movement is one of scans, which see it better than images without features do.
  bool by_scans = false;
  /// Image regions of people and the like, px: their features are not used.
  std::vector<Box2> dynamic_regions;
};

/// Outcome for one frame.
struct TrackingResult {
  bool tracked = false;
  bool predicted = false;  ///< not tracked, but for a moment the velocity before says where, with its covariance
  /// Why not: "too few features", "too few inliers", "no depth", …; of a tracked frame, how, if not in the usual way.
  std::string reason;
  Pose3 odom_from_camera = Pose3::Identity();  ///< pose in the tracker's own, drifting frame
  int segment = 0;  ///< counts up where no movement leads from the last pose: closures and links tie segments together
  int inliers = 0, matches = 0;
  int moving = 0;  ///< features of something that moves before the camera, and was left out
  bool keyframe = false;
  Matrix6d step_covariance =
      Matrix6d::Identity();            ///< of the movement since the last frame (translation, rotation)
  std::vector<FeatureTrack> features;  ///< the tracked ones: lets later stages count shared features per box
};

/// RGB-D visual odometry: frame in, pose in the tracker's own frame out.
class RgbdOdometry : public Stage {
  DEFINE_VIRTUAL_MRPT_OBJECT(RgbdOdometry)
 public:
  virtual TrackingResult track(const Frame& frame, const TrackingPrior& prior) = 0;

  /// A frame that will be tracked: what depends on it alone may be computed now and kept until its turn. Called after
  /// prepare(), in the order of the frames, beside all other calls, or not at all; the outcome is the same.
  virtual void foresee(const Frame& frame) { (void)frame; }

  /// Best current estimate of every tracked frame (later frames refine earlier ones), in the tracker's frame.
  virtual Trajectory trajectory() const = 0;

  /// Loop closures found since the last call, and links between segments, between cameras at two frame times (a_from_b of
  /// the optical frames).
  virtual std::vector<RelativePose> takeLoopClosures() { return {}; }

  /// Checks and refines a closure that something else proposed, between the cameras near its two times;
  /// nothing when the images do not confirm it.
  virtual std::optional<RelativePose> verifyLoop(const RelativePose& proposed) {
    (void)proposed;
    return std::nullopt;
  }

  /// Nothing more comes or will be asked: the memory of what was seen is given back. prepare() begins anew.
  virtual void release() {}
};

}  // namespace roomgraph
