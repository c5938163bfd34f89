// SPDX-License-Identifier: BSD-3-Clause
// Distortion models of ROS and maps for their removal.
#include "camera_model.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace roomgraph::bags {
namespace {

constexpr std::size_t kPlumbBob = 5;

cv::Matx33d matrixOf(const PinholeCamera& camera) {
  return {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
}

bool allZero(const std::vector<double>& values, std::size_t from = 0) {
  return std::all_of(values.begin() + static_cast<std::ptrdiff_t>(std::min(from, values.size())),
                     values.end(), [](double value) { return value == 0; });
}

void removeDistortion(CameraModel& model, const std::vector<double>& distortion, bool fisheye) {
  const cv::Matx33d k = matrixOf(model.camera);
  const cv::Size size(model.camera.width, model.camera.height);
  if (fisheye)
    cv::fisheye::initUndistortRectifyMap(k, cv::Mat(distortion).clone(), cv::noArray(), k, size, CV_32FC1,
                                         model.map_x, model.map_y);
  else
    cv::initUndistortRectifyMap(k, distortion, cv::noArray(), k, size, CV_32FC1, model.map_x, model.map_y);
}

std::string sizeText(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height) + " px";
}

// Of the message, which counts pixels of the sensor, binned. K and P are of the whole sensor.
cv::Rect regionOf(const CameraInfoMessage& info, cv::Size binning, cv::Size images) {
  const auto binned = [&](std::uint32_t width, std::uint32_t height) {
    return cv::Size(static_cast<int>(width) / binning.width, static_cast<int>(height) / binning.height);
  };
  const auto whole = binned(info.width, info.height);
  const bool inside = info.roi_width > 0 && info.roi_height > 0 && info.roi_x < info.width &&
                      info.roi_y < info.height && info.roi_width <= info.width - info.roi_x &&
                      info.roi_height <= info.height - info.roi_y;
  if (!inside) return {cv::Point(), whole};
  const auto region = binned(info.roi_width, info.roi_height);
  // Some drivers tell of a region and send the whole image all the same.
  if (!images.empty() && images != region) return {cv::Point(), whole};
  return {cv::Point(static_cast<int>(info.roi_x), static_cast<int>(info.roi_y)), region};
}

}  // namespace

PinholeCamera fittedTo(const PinholeCamera& camera, cv::Size images) {
  constexpr double kRounded_px = 0.6;
  const cv::Size size(camera.width, camera.height);
  if (images.empty() || images == size) return camera;
  const double scale = static_cast<double>(images.width) / size.width;
  if (std::abs(scale * size.height - images.height) > kRounded_px)
    throw BadMessage("is of " + sizeText(size) + ", the images of " + sizeText(images));
  PinholeCamera out = camera.scaled(scale);
  out.height = images.height;
  return out;
}

cv::Mat CameraModel::rectified(const cv::Mat& image, bool depth) const {
  if (map_x.empty() || image.size() != map_x.size()) return image;
  cv::Mat out;
  cv::remap(image, out, map_x, map_y, depth ? cv::INTER_NEAREST : cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return out;
}

CameraModel cameraModel(const CameraInfoMessage& info, bool rectified, cv::Size images) {
  constexpr std::uint32_t kLargest = 1u << 14;
  CameraModel model;
  auto& camera = model.camera;
  if (info.width > kLargest || info.height > kLargest) throw BadMessage("camera_info: impossible image size");
  const int bin_x = static_cast<int>(std::clamp(info.binning_x, 1u, kLargest));
  const int bin_y = static_cast<int>(std::clamp(info.binning_y, 1u, kLargest));
  const cv::Rect region = regionOf(info, {bin_x, bin_y}, images);
  camera.width = region.width;
  camera.height = region.height;
  const bool projection = rectified && info.p[0] > 0;
  const auto pick = [&](std::size_t in_k, std::size_t in_p) {
    return projection ? info.p[in_p] : info.k[in_k];
  };
  camera.fx = pick(0, 0) / bin_x;
  camera.fy = pick(4, 5) / bin_y;
  camera.cx = (pick(2, 2) - region.x) / bin_x;
  camera.cy = (pick(5, 6) - region.y) / bin_y;
  const bool finite = std::isfinite(camera.fx + camera.fy + camera.cx + camera.cy);
  if (!finite || !camera.valid())
    throw BadMessage("camera_info: the camera is not calibrated (no size or focal length)");
  camera = fittedTo(camera, images);
  model.scale = static_cast<double>(camera.width) / region.width;
  const auto& d = info.distortion;
  if (rectified || allZero(d)) return model;
  if (!std::all_of(d.begin(), d.end(), [](double value) { return std::isfinite(value); }))
    throw BadMessage("camera_info: distortion is not finite");
  const bool fisheye = info.distortion_model == "equidistant" || info.distortion_model == "fisheye";
  if (!fisheye && info.distortion_model != "plumb_bob" && info.distortion_model != "rational_polynomial" &&
      !info.distortion_model.empty())
    throw BadMessage("camera_info: distortion model '" + info.distortion_model + "' is not known");
  if (fisheye ? d.size() != 4
              : d.size() != 4 && d.size() != kPlumbBob && d.size() != 8 && d.size() != 12 && d.size() != 14)
    throw BadMessage("camera_info: " + std::to_string(d.size()) + " coefficients of distortion");
  if (!fisheye && allZero(d, kPlumbBob))
    std::copy_n(d.begin(), std::min(kPlumbBob, d.size()), camera.distortion.begin());
  else
    removeDistortion(model, d, fisheye);
  return model;
}

}  // namespace roomgraph::bags
