// SPDX-License-Identifier: BSD-3-Clause
// Intrinsics between PinholeCamera and MRPT's TCamera; models of distortion.
#pragma once

#include <mrpt/img/TCamera.h>

#include <string>
#include <vector>

#include "roomgraph/geometry/camera.h"

namespace roomgraph {

/// Pixels; distortion as plumb_bob, none when all its coefficients are zero.
mrpt::img::TCamera toMrpt(const PinholeCamera& camera);
/// The inverse. Of other models of distortion it has the first coefficients only: what they do is to be taken out of the images.
PinholeCamera toPinhole(const mrpt::img::TCamera& camera);

/// What a lens does to an image, by the names of ROS (sensor_msgs/CameraInfo).
struct Distortion {
  /// "plumb_bob": k1 k2 p1 p2 k3; "rational_polynomial": k4 k5 k6 beside them; "equidistant": k1 to k4 of Kannala and Brandt
  /// (2006), for fisheye lenses. Formulas: OpenCV's calib3d.
  std::string model = "plumb_bob";
  std::vector<double> coefficients = std::vector<double>(5);

  bool isFisheye() const { return model == "equidistant"; }
  bool operator==(const Distortion&) const = default;
};

Distortion distortionOf(const PinholeCamera& camera);
Distortion distortionOf(const mrpt::img::TCamera& camera);

}  // namespace roomgraph
