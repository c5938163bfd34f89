// SPDX-License-Identifier: BSD-3-Clause
// Intrinsics, undistortion, colour conversion and depth registration of an RGB-D record.
#include "frame_conversion.h"

#include <mrpt/core/Clock.h>
#include <mrpt/io/lazy_load_path.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "depth_registration.h"
#include "flag_repair.h"
#include "image_memory.h"
#include "lens_removal.h"
#include "record_source.h"
#include "roomgraph/core/unexpected.h"
#include "roomgraph/observations/mrpt_camera.h"

namespace roomgraph {
namespace {

using mrpt::obs::CObservation3DRangeScan;

// MRPT's poses of cameras look along x; images are in optical axes (x right, y down, z forward).
Pose3 forwardFromOptical() {
  Pose3 pose = Pose3::Identity();
  pose.linear() = bodyFromOptical();
  return pose;
}

bool isDistorted(const PinholeCamera& camera) {
  return std::any_of(camera.distortion.begin(), camera.distortion.end(), [](double d) { return d != 0; });
}

cv::Mat undistorted(const cv::Mat& image, const PinholeCamera& camera, int interpolation) {
  return withoutLens(image, camera, distortionOf(camera), interpolation);
}

void setColor(Frame& frame, const mrpt::img::CImage& image, const std::optional<Distortion>& lens) {
  const cv::Mat pixels = image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
  if (pixels.channels() == 1) {
    frame.gray = pixels;
    cv::cvtColor(pixels, frame.color, cv::COLOR_GRAY2BGR);
  } else {
    frame.color = pixels;  // MRPT has BGR only
  }
  if (lens || isDistorted(frame.camera)) {
    frame.color = lens ? withoutLens(frame.color, frame.camera, *lens, cv::INTER_LINEAR) : undistorted(frame.color, frame.camera, cv::INTER_LINEAR);
    frame.gray.release();
  }
  if (frame.gray.empty()) cv::cvtColor(frame.color, frame.gray, cv::COLOR_BGR2GRAY);
}

cv::Mat rangesInMetres(const CObservation3DRangeScan& observation) {
  const auto& ranges = observation.rangeImage;
  const cv::Mat units(static_cast<int>(ranges.rows()), static_cast<int>(ranges.cols()), CV_16UC1,
                      const_cast<std::uint16_t*>(ranges.data()));
  cv::Mat metres;
  units.convertTo(metres, CV_32F, observation.rangeUnits);
  return metres;
}

void setDepth(Frame& frame, const CObservation3DRangeScan& observation, const PinholeCamera& depth_camera,
              const std::optional<Distortion>& lens) {
  cv::Mat depth = rangesInMetres(observation);
  if (lens) depth = withoutLens(depth, depth_camera, *lens, cv::INTER_NEAREST);
  const bool registered = depthIsRegistered(observation, frame.camera, depth_camera);
  cv::Mat rays;
  if (!observation.range_is_depth || !registered) rays = pixelRays(depth_camera, distortionOf(depth_camera));
  if (!observation.range_is_depth) rangesToDepth(depth, rays);
  if (!registered) {
    const Pose3 color_from_depth =
        toPose3(observation.relativePoseIntensityWRTDepth).inverse() * forwardFromOptical();
    PinholeCamera target = frame.camera;
    target.distortion = {};
    depth = registerDepth(depth, rays, depth_camera.fx, color_from_depth, target);
  } else if (isDistorted(depth_camera)) {
    depth = undistorted(depth, depth_camera, cv::INTER_NEAREST);
  }
  frame.depth = depth;
}

Outcome<Frame> convert(CObservation3DRangeScan& observation, const std::string& image_folder) {
  using Result = Outcome<Frame>;
  if (const auto missing = missingExternalFile(observation, image_folder); !missing.empty())
    return Result::failure("image missing: " + missing);
  loadImages(observation);
  const auto& ranges = observation.rangeImage;
  const bool has_depth = observation.hasRangeImage && ranges.rows() > 0 && ranges.cols() > 0;
  const bool has_color = observation.hasIntensityImage && !observation.intensityImage.isEmpty();
  if (!has_depth && !has_color) return Result::failure("CObservation3DRangeScan: no image in it");

  Frame frame;
  frame.t = mrpt::Clock::toDouble(observation.timestamp);
  frame.sensor_label = observation.sensorLabel;
  const Pose3 robot_from_depth = toPose3(observation.sensorPose);
  PinholeCamera depth_camera = cameraForImage(observation.cameraParams, static_cast<int>(ranges.cols()),
                                              static_cast<int>(ranges.rows()));
  // What these lenses did is taken out of the images first.
  const auto depth_lens = has_depth ? otherLensOf(observation.cameraParams) : std::nullopt;
  const auto color_lens = has_color ? otherLensOf(observation.cameraParamsIntensity) : std::nullopt;
  if (depth_lens) depth_camera.distortion = {};
  if (has_color) {
    const auto& image = observation.intensityImage;
    frame.camera = cameraForImage(observation.cameraParamsIntensity, static_cast<int>(image.getWidth()),
                                  static_cast<int>(image.getHeight()));
    if (color_lens) frame.camera.distortion = {};
    frame.robot_from_camera = robot_from_depth * toPose3(observation.relativePoseIntensityWRTDepth);
  } else {
    frame.camera = depth_camera;
    frame.robot_from_camera = robot_from_depth * forwardFromOptical();
  }
  if (!frame.camera.valid() || (has_depth && !depth_camera.valid()))
    return Result::failure("CObservation3DRangeScan: no camera intrinsics that fit the image size");
  if (has_color) setColor(frame, observation.intensityImage, color_lens);
  if (has_depth) setDepth(frame, observation, depth_camera, depth_lens);
  frame.camera.distortion = {};
  return frame;
}

}  // namespace

PinholeCamera cameraForImage(const mrpt::img::TCamera& calibration, int width, int height) {
  const PinholeCamera camera = toPinhole(calibration);
  if (width == camera.width && height == camera.height) return camera;
  if (1LL * width * camera.height != 1LL * height * camera.width || camera.width <= 0) return {};
  return camera.scaled(static_cast<double>(width) / camera.width);
}

bool depthIsRegistered(const CObservation3DRangeScan& observation, const PinholeCamera& color,
                       const PinholeCamera& depth) {
  const auto close = [](double a, double b) { return std::abs(a - b) < 0.01; };  // px
  return !observation.hasIntensityImage ||
         (observation.doDepthAndIntensityCamerasCoincide() && color.width == depth.width &&
          color.height == depth.height && close(color.fx, depth.fx) && close(color.fy, depth.fy) &&
          close(color.cx, depth.cx) && close(color.cy, depth.cy) && color.distortion == depth.distortion);
}

std::string missingExternalFile(const CObservation3DRangeScan& observation, const std::string& image_folder) {
  mrpt::io::setLazyLoadPathBase(image_folder);
  const auto missing = [](const std::string& file) { return !std::filesystem::exists(file); };
  if (observation.hasIntensityImage && observation.intensityImage.isExternallyStored()) {
    auto file = observation.intensityImage.getExternalStorageFileAbsolutePath();
    if (missing(file)) return file;
  }
  if (observation.hasRangeImage && rangeImageIsInAFile(observation)) {
    auto file = observation.rangeImage_getExternalStorageFileAbsolutePath("");
    if (missing(file)) return file;
  }
  return "";
}

Outcome<Frame> toFrame(CObservation3DRangeScan& observation, const std::string& image_folder) {
  const std::size_t shortages = memoryShortages();
  try {
    return convert(observation, image_folder);
  } catch (const std::exception& error) {
    throwIfShort(error, shortages);
    return Outcome<Frame>::failure("CObservation3DRangeScan: image unreadable: " + firstLine(error));
  }
}

}  // namespace roomgraph
