// SPDX-License-Identifier: BSD-3-Clause
// RGB-D frame: undistorted colour, grey and depth images with camera and extrinsics.
#pragma once

#include <cmath>
#include <opencv2/core/mat.hpp>
#include <string>

#include "roomgraph/core/ids.h"
#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// One RGB-D image pair; depth is registered to the colour image, both are undistorted.
struct Frame {
  FrameId id;
  double t = 0;   ///< s
  cv::Mat color;  ///< CV_8UC3, BGR; empty when the record has depth only
  cv::Mat gray;   ///< CV_8UC1
  cv::Mat depth;  ///< CV_32FC1, metres along the optical axis, 0 = no measurement; empty when absent
  PinholeCamera camera;
  Pose3 robot_from_camera = Pose3::Identity();  ///< optical frame
  std::string sensor_label;

  bool hasDepth() const { return !depth.empty(); }
  /// Depth at the nearest pixel, 0 when there is none.
  float depthAt(double u, double v) const {
    const int x = static_cast<int>(std::floor(u + 0.5)), y = static_cast<int>(std::floor(v + 0.5));
    return hasDepth() && u > -0.5 && v > -0.5 && x < depth.cols && y < depth.rows ? depth.at<float>(y, x)
                                                                                  : 0.f;
  }
};

}  // namespace roomgraph
