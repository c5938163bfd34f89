// SPDX-License-Identifier: BSD-3-Clause
// OpenCV's maps of lenses, made once for each camera.
#include "lens_removal.h"

#include <array>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "recent.h"

namespace roomgraph {
namespace {

// Where the pixels of a pinhole camera lie in the image of the lens, px, CV_32FC1.
struct PixelMaps {
  cv::Mat x, y;
};

PixelMaps makeMaps(const PinholeCamera& camera, const Distortion& lens, cv::Size size) {
  const cv::Matx33d k(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  PixelMaps maps;
  if (lens.isFisheye())
    cv::fisheye::initUndistortRectifyMap(k, lens.coefficients, cv::Matx33d::eye(), k, size, CV_32FC1, maps.x, maps.y);
  else
    cv::initUndistortRectifyMap(k, lens.coefficients, cv::noArray(), k, size, CV_32FC1, maps.x, maps.y);
  return maps;
}

// To make them takes longer than to use them.
PixelMaps mapsOf(const PinholeCamera& camera, const Distortion& lens, cv::Size size) {
  using Key = std::tuple<std::array<double, 4>, Distortion, int, int>;
  static Recent<Key, PixelMaps> recent(4);
  const Key key({camera.fx, camera.fy, camera.cx, camera.cy}, lens, size.width, size.height);
  return recent.of(key, [&] { return makeMaps(camera, lens, size); });
}

}  // namespace

std::optional<Distortion> otherLensOf(const mrpt::img::TCamera& camera) {
  Distortion lens = distortionOf(camera);
  if (lens.model == "plumb_bob") return std::nullopt;
  return lens;
}

cv::Mat withoutLens(const cv::Mat& image, const PinholeCamera& camera, const Distortion& lens, int interpolation) {
  const PixelMaps maps = mapsOf(camera, lens, image.size());
  cv::Mat out;
  cv::remap(image, out, maps.x, maps.y, interpolation, cv::BORDER_CONSTANT);
  return out;
}

}  // namespace roomgraph
