// SPDX-License-Identifier: BSD-3-Clause
// Rendered RGB-D frames of a box room with random textures.
#pragma once

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "bilinear.h"
#include "roomgraph/observations/frame.h"

namespace roomgraph::test {

/// Inside of a 6 x 4 x 3 m box whose faces carry random textures, seen by an ideal RGB-D camera. World: the
/// box spans x in [-3, 3], y in [-1.5, 1.5] (down), z in [-2, 2]; exact depth, no noise.
class TexturedRoom {
 public:
  explicit TexturedRoom(unsigned seed = 1) {
    std::mt19937 random(seed);
    for (int face = 0; face < 6; ++face) {
      cv::Mat coarse(160, 160, CV_8UC1), fine;
      for (int i = 0; i < coarse.rows * coarse.cols; ++i)
        coarse.data[i] = static_cast<unsigned char>(random() % 256);
      cv::resize(coarse, fine, {640, 640}, 0, 0, cv::INTER_NEAREST);
      cv::GaussianBlur(fine, fine, {}, 1.0);
      textures_.push_back(fine);
    }
  }

  static PinholeCamera camera() { return {320, 240, 260, 260, 159.5, 119.5, {}}; }

  Frame render(double t, const Pose3& world_from_camera) const {
    Frame frame;
    frame.t = t;
    frame.camera = camera();
    frame.gray.create(frame.camera.height, frame.camera.width, CV_8UC1);
    frame.depth.create(frame.camera.height, frame.camera.width, CV_32FC1);
    for (int v = 0; v < frame.gray.rows; ++v)
      for (int u = 0; u < frame.gray.cols; ++u) {
        const Eigen::Vector3d ray = world_from_camera.linear() * frame.camera.ray(u, v);
        const auto [z, value] = cast(world_from_camera.translation(), ray);
        frame.depth.at<float>(v, u) = static_cast<float>(z);
        frame.gray.at<unsigned char>(v, u) = value;
      }
    cv::cvtColor(frame.gray, frame.color, cv::COLOR_GRAY2BGR);
    return frame;
  }

 private:
  std::pair<double, unsigned char> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) const {
    const Eigen::Vector3d half(3, 1.5, 2);
    double nearest = std::numeric_limits<double>::infinity();
    int face = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(ray[axis]) < 1e-12) continue;
      const double s = (std::copysign(half[axis], ray[axis]) - origin[axis]) / ray[axis];
      if (s >= nearest) continue;
      nearest = s;
      face = 2 * axis + (ray[axis] > 0);
    }
    const Eigen::Vector3d hit = origin + nearest * ray;
    const int axis = face / 2;
    const double a = (hit[(axis + 1) % 3] + 3) * 100, b = (hit[(axis + 2) % 3] + 3) * 100;
    return {nearest, bilinear(textures_[static_cast<std::size_t>(face)], a, b)};
  }

  std::vector<cv::Mat> textures_;
};

}  // namespace roomgraph::test
