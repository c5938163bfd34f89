// SPDX-License-Identifier: BSD-3-Clause
// Pinhole camera of a CameraInfo message; removal of distortions that it cannot express.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "messages.h"
#include "roomgraph/geometry/camera.h"

namespace roomgraph::bags {

/// How images of a topic are to be understood.
struct CameraModel {
  PinholeCamera camera;  ///< of the images as they are recorded in the rawlog
  /// Pixel of the message's image for each pixel (CV_32FC1, x and y); empty: images stay as they are.
  cv::Mat map_x, map_y;
  double scale = 1;  ///< from the size of the calibration to that of the images

  /// The image without the distortion that `camera` lacks. Depth is not interpolated.
  cv::Mat rectified(const cv::Mat& image, bool depth) const;
};

/// The camera of images of this size, of which a driver has made those of another: scaled. Throws BadMessage:
/// of another shape.
PinholeCamera fittedTo(const PinholeCamera& camera, cv::Size images);

/// `rectified`: the topic's images are free of distortion already (image_rect): the projection matrix counts.
/// Up to five coefficients of plumb_bob stay with the camera; eight of rational_polynomial and the four of
/// equidistant (fisheye) lenses are removed from the images. Throws BadMessage: not calibrated (no focal
/// length), model not known.
///
/// `images`: their size; empty: not known, then that of the message. It tells whether they are the region of
/// interest, and is fittedTo().
CameraModel cameraModel(const CameraInfoMessage& info, bool rectified, cv::Size images = {});

}  // namespace roomgraph::bags
