// SPDX-License-Identifier: BSD-3-Clause
// Place recognition by thumbnails, descriptor matching and PnP.
#pragma once

#include <optional>
#include <vector>

#include "local_map.h"
#include "matcher.h"
#include "pose_solver.h"

namespace roomgraph::tracking {

/// Small blurred image, zero mean and unit norm: the dot product of two is their similarity
/// (Klein & Murray, ECCV 2008, "small blurry images").
cv::Mat makeThumbnail(const cv::Mat& gray);
double similarity(const cv::Mat& thumbnail_a, const cv::Mat& thumbnail_b);

/// Relocalisation of an image against one keyframe: descriptor matching, PnP with RANSAC, refinement.
struct Recognition {
  PoseSolution solution;                 ///< camera_from_world is camera_from_keyframe
  std::vector<PointMatch> known_points;  ///< inliers whose keyframe feature has a map point
};
Recognition recognize(const LocalMap& map, int keyframe, const Features& features,
                      const PinholeCamera& camera, const TrackingParameters& parameters);

/// Keyframes of [0, end) by similarity with a thumbnail, most similar first, at most `count`; none that was given up.
std::vector<int> mostSimilar(const LocalMap& map, const cv::Mat& thumbnail, int end, int count);

/// Older keyframes that may show what keyframe `index` shows: similar ones and the nearest one in its
/// frame.
std::vector<int> loopCandidates(const LocalMap& map, int index, const TrackingParameters& parameters);

}  // namespace roomgraph::tracking
