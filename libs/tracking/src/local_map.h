// SPDX-License-Identifier: BSD-3-Clause
// Local map of visual odometry: keyframes, map points, covisibility.
#pragma once

#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "depth_sketch.h"
#include "feature_extractor.h"
#include "point_store.h"
#include "reprojection.h"

namespace roomgraph::tracking {

struct Keyframe {
  double t = 0;
  int segment = 0;  ///< those of one were tracked without a break
  int origin = 0;   ///< the keyframe that began its frame `odom`; poses in that of another one are unrelated
  PinholeCamera camera;
  Pose3 odom_from_camera = Pose3::Identity();
  Features features;                 ///< without grid, which is made when features are searched
  std::vector<std::int64_t> points;  ///< per feature: id of its point, -1: none
  cv::Mat thumbnail;                 ///< see place_recognition.h
  DepthSketch sketch;
  int shown_by = -1;  ///< the older keyframe for which it was given up: then features and depth are gone

  bool isGivenUp() const { return shown_by >= 0; }

  Observation observation(int feature, const TrackingParameters& parameters) const;
};

/// Keyframes and map points of all segments, each in the frame of its origin. Invariant: a keyframe's feature names a point exactly when
/// the point lists that sighting.
struct LocalMap {
  std::deque<Keyframe> keyframes;  ///< which are not copied when there are more
  PointStore points;

  MapPoint& point(std::int64_t id) { return points[static_cast<std::size_t>(id)]; }
  const MapPoint& point(std::int64_t id) const { return points[static_cast<std::size_t>(id)]; }
  bool has(int keyframe) const { return keyframe >= 0 && keyframe < static_cast<int>(keyframes.size()); }
  Keyframe& keyframe(int index) { return keyframes[static_cast<std::size_t>(index)]; }
  const Keyframe& keyframe(int index) const { return keyframes[static_cast<std::size_t>(index)]; }

  /// New point from a feature with depth.
  std::int64_t createPoint(int keyframe, int feature);
  void addSighting(std::int64_t point, int keyframe, int feature);
  void removeSighting(std::int64_t point, int keyframe);
  void looksAsSeenLast(MapPoint& point);
  void erase(std::int64_t point);
  /// Gives back what the keyframe takes, and its points that no other shows; `older` shows what it showed. Time and pose stay.
  void giveUp(int keyframe, int older);
  /// (number of these points seen, keyframe) of all keyframes that saw any, in descending order.
  std::vector<std::pair<int, int>> covisible(const std::vector<std::int64_t>& ids) const;
  /// Valid points of these keyframes, ascending, each once.
  std::vector<std::int64_t> pointsOf(const std::vector<int>& keyframe_indices) const;
};

}  // namespace roomgraph::tracking
