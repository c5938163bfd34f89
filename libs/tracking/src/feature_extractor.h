// SPDX-License-Identifier: BSD-3-Clause
// ORB features of an image with depth.
#pragma once

#include <opencv2/core.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "feature_grid.h"
#include "point_store.h"
#include "roomgraph/geometry/box.h"
#include "roomgraph/observations/frame.h"
#include "tracking_parameters.h"

namespace roomgraph::tracking {

/// Features of one image. All vectors have the same length.
struct Features {
  std::vector<FeaturePlace> places;
  std::vector<Descriptor> descriptors;  ///< ORB
  std::vector<float> depth;             ///< m, 0: none, or not to be relied on
  FeatureGrid grid;

  std::size_t size() const { return places.size(); }
  Eigen::Vector2d pixel(std::size_t i) const { return {places[i].pt.x, places[i].pt.y}; }
  std::ptrdiff_t withDepth() const { return std::count_if(depth.begin(), depth.end(), [](float z) { return z > 0; }); }
};

/// Corners of an image as FAST finds them, level by level: what features need that depends on the image alone.
struct Corners {
  struct Level {
    cv::Mat image;
    std::vector<cv::KeyPoint> corners;  ///< px within the border
  };
  std::vector<Level> levels;  ///< fine to coarse
};
Corners findCorners(const cv::Mat& gray, const TrackingParameters& parameters);

/// Oriented FAST corners, spread evenly over the image on each pyramid level, with ORB descriptors
/// (Rublee et al., ICCV 2011). Corners inside an excluded box (px) are left out. `corners` are those of `gray`.
Features extractFeatures(const cv::Mat& gray, const Corners& corners, const Frame& frame,
                         const std::vector<Box2>& excluded, const TrackingParameters& parameters);
Features extractFeatures(const cv::Mat& gray, const Frame& frame, const std::vector<Box2>& excluded,
                         const TrackingParameters& parameters);

}  // namespace roomgraph::tracking
