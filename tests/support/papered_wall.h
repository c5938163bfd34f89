// SPDX-License-Identifier: BSD-3-Clause
// Rendered RGB-D frames of an endless wall whose random paper repeats itself.
#pragma once

#include <cmath>
#include <random>

#include <opencv2/imgproc.hpp>

#include "bilinear.h"
#include "roomgraph/observations/frame.h"

namespace roomgraph::test {

/// A wall 2 m before the origin of the camera, across its axis; along x the paper is the same after each period. Exact depth, no noise.
class PaperedWall {
 public:
  explicit PaperedWall(double period_m) : period_m_(period_m), paper_(600, 2000, CV_8UC1) {
    std::mt19937 random(3);
    cv::Mat coarse(150, 500, CV_8UC1);
    for (int i = 0; i < coarse.rows * coarse.cols; ++i) coarse.data[i] = static_cast<unsigned char>(random() % 256);
    cv::resize(coarse, paper_, paper_.size(), 0, 0, cv::INTER_NEAREST);
    cv::GaussianBlur(paper_, paper_, {}, 1.0);
  }

  /// The camera moves in the plane of the wall: its axis stays across it.
  Frame render(double t, const Pose3& world_from_camera) const {
    Frame frame;
    frame.t = t;
    frame.camera = {320, 240, 260, 260, 159.5, 119.5, {}};
    frame.gray.create(frame.camera.height, frame.camera.width, CV_8UC1);
    frame.depth.create(frame.camera.height, frame.camera.width, CV_32FC1);
    frame.depth.setTo(kDistance_m);
    for (int v = 0; v < frame.gray.rows; ++v)
      for (int u = 0; u < frame.gray.cols; ++u) {
        const Eigen::Vector3d hit = world_from_camera * (kDistance_m * frame.camera.ray(u, v));
        frame.gray.at<unsigned char>(v, u) = bilinear(paper_, kPixels_m * std::fmod(hit.x() + 10, period_m_), kPixels_m * (hit.y() + 3));
      }
    cv::cvtColor(frame.gray, frame.color, cv::COLOR_GRAY2BGR);
    return frame;
  }

 private:
  static constexpr double kDistance_m = 2, kPixels_m = 100;

  double period_m_;
  cv::Mat paper_;
};

}  // namespace roomgraph::test
