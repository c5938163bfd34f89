// SPDX-License-Identifier: BSD-3-Clause
// OpenCV's maps of fisheye and rational lenses.
#include "lens_removal.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace roomgraph {

std::optional<Lens> otherLensOf(const mrpt::img::TCamera& camera) {
  if (camera.distortion == mrpt::img::DistortionModel::kannala_brandt)
    return Lens{true, {camera.k1(), camera.k2(), camera.k3(), camera.k4()}};
  if (camera.k4() == 0 && camera.k5() == 0 && camera.k6() == 0) return std::nullopt;
  return Lens{
      false, {camera.k1(), camera.k2(), camera.p1(), camera.p2(), camera.k3(), camera.k4(), camera.k5(), camera.k6()}};
}

cv::Mat withoutLens(const cv::Mat& image, const PinholeCamera& camera, const Lens& lens, int interpolation) {
  const cv::Matx33d k(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  cv::Mat map_x, map_y, out;
  if (lens.fisheye)
    cv::fisheye::initUndistortRectifyMap(k, lens.coefficients, cv::Matx33d::eye(), k, image.size(), CV_32FC1, map_x, map_y);
  else
    cv::initUndistortRectifyMap(k, lens.coefficients, cv::noArray(), k, image.size(), CV_32FC1, map_x, map_y);
  cv::remap(image, out, map_x, map_y, interpolation, cv::BORDER_CONSTANT);
  return out;
}

}  // namespace roomgraph
