// SPDX-License-Identifier: BSD-3-Clause
// Tracking of detected boxes through frames on which the detector does not run.
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <optional>
#include <vector>

#include "roomgraph/geometry/pose.h"
#include "roomgraph/observations/detection.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// Carries the boxes of the last detection through the frames on which the detector does not run. Until when they
/// may be carried is not decided here.
///
/// Corners on the object (by depth, where there is depth) are followed by pyramidal Lucas-Kanade with a
/// forward-backward check; the median of their distance ratios is the box's scale, the median of the remaining
/// displacements its shift (Kalal et al., "Forward-Backward Error", ICPR 2010). Corners are compared with where they
/// were when they were chosen, so that rounding does not add up from frame to frame. A box with too few corners, of a
/// class that does not move by itself, is predicted from the camera's movement and its depth, as long as the depth
/// image agrees. A box with neither support, or outside the image, ends.
class BoxTracker {
 public:
  /// The database outlives the tracker; it says which classes move by themselves (landmark = false).
  explicit BoxTracker(const ObjectDatabase& database) : database_(&database) {}

  /// Begins with the boxes of a frame on which the detector ran; drops all earlier ones.
  void start(const std::vector<Detection>& detections, const Frame& frame);
  /// The boxes in the next frame, marked as carried, in the order they were started in; those that ended are
  /// left out. Nothing when this frame or the last one has no image, or their sizes differ; then, and before the
  /// first start(), there is nothing to carry until start() is called. `previous_from_current`: movement of the
  /// camera since the last frame given to start() or advance(), optical frames; nothing when it is not known.
  std::optional<std::vector<Detection>> advance(const Frame& frame,
                                                const std::optional<Pose3>& previous_from_current);

 private:
  struct Track {
    Detection detection;
    cv::Mat mask;        ///< of the whole object as it was detected; empty: none
    Box2 anchor;         ///< box when the corners were chosen, px; may reach outside the image
    Box2 box;            ///< now; may reach outside the image
    double depth_m = 0;  ///< of the object now, along the optical axis; 0: not measured
    std::vector<cv::Point2f> anchor_points, points;  ///< corners then and now, pairwise
    std::size_t chosen = 0;                          ///< corners at the anchor
  };
  struct Flow {
    std::vector<cv::Point2f> points;
    std::vector<char> good;
  };

  bool moves(const Detection& detection) const;
  void chooseCorners(Track& track, const Frame& frame) const;
  cv::Mat cornerMask(const Track& track, const Frame& frame, const cv::Rect& region) const;
  Flow follow(const std::vector<cv::Mat>& pyramid) const;
  bool moveByCorners(Track& track, const Flow& flow, std::size_t first) const;
  bool moveByCamera(Track& track, const Frame& frame,
                    const std::optional<Pose3>& previous_from_current) const;
  bool settle(Track& track, const Frame& frame) const;

  const ObjectDatabase* database_;
  std::vector<Track> tracks_;
  std::vector<cv::Mat> pyramid_;  ///< of the last frame; empty: nothing is carried
};

}  // namespace roomgraph
