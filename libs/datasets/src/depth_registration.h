// SPDX-License-Identifier: BSD-3-Clause
// Registration of a depth image to the colour camera; ranges along rays to depths.
#pragma once

#include <opencv2/core/mat.hpp>

#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/pose.h"
#include "roomgraph/observations/mrpt_camera.h"

namespace roomgraph {

/// Directions K^-1 (u, v, 1) of a camera's pixels with what the lens does removed, CV_32FC2 (x, y at z = 1).
/// Not to be written to: shared by those who ask for the same camera.
cv::Mat pixelRays(const PinholeCamera& camera, const Distortion& lens);

/// Distances along the rays turned into depths along the optical axis. `range`: CV_32FC1, changed in place.
void rangesToDepth(cv::Mat& range, const cv::Mat& rays);

/// A depth image seen from another camera: every pixel becomes a small square in space; the nearest one wins.
/// `depth` CV_32FC1 in metres with its `rays`, from a camera of focal length `depth_fx` (px). Result:
/// CV_32FC1 of the size of `target`, 0 where nothing was projected. The target must be free of distortion.
cv::Mat registerDepth(const cv::Mat& depth, const cv::Mat& rays, double depth_fx,
                      const Pose3& target_from_depth, const PinholeCamera& target);

}  // namespace roomgraph
