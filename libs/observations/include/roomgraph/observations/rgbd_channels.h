// SPDX-License-Identifier: BSD-3-Clause
// Picture of an RGB-D frame as a network takes it: colour, inverse depth, height above the floor, slope.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "roomgraph/geometry/camera.h"

namespace roomgraph {

/// Channels of rgbdChannels(), in their order.
enum RgbdChannel { kBlue, kGreen, kRed, kInverseDepth, kHeight, kSlope, kRgbdChannels };

/// Where the floor is, by one depth image alone.
struct Levelling {
  Eigen::Vector3d up{0, -1, 0};  ///< unit vector against gravity, optical frame
  double camera_height_m = 0;    ///< of the optical centre above the lowest level surface that is seen
};

/// Direction of gravity and height of the camera by the surfaces of one depth image: floors and table tops
/// are level, walls are plumb (Gupta, Arbelaez, Malik, "Perceptual organization and recognition of indoor
/// scenes from RGB-D images", CVPR 2013, sec. 3). It is assumed that the camera leans by less than about 45
/// degrees. `depth`: CV_32F, m, 0 = no measurement. Nothing when too little is measured.
std::optional<Levelling> levelling(const cv::Mat& depth, const PinholeCamera& camera);

/// Six images of `size`, CV_8U, in the order of RgbdChannel. Inverse depth: 255 sqrt(.4 m / z). Height above
/// the lowest level surface: 1 + 254 (h + .2 m) / 2.6 m. Slope: the upward part of the surface's normal, 1 +
/// 127 (n . up + 1). Each is cut off at the ends of its range and is 0 where nothing is measured, and
/// everywhere without depth. `color`: CV_8UC3, BGR; `depth`: CV_32F, m, of the same camera (any size), or
/// empty. The images are stretched to `size`.
std::vector<cv::Mat> rgbdChannels(const cv::Mat& color, const cv::Mat& depth, const PinholeCamera& camera,
                                  cv::Size size);

}  // namespace roomgraph
