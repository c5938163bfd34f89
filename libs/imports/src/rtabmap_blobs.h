// SPDX-License-Identifier: BSD-3-Clause
// Binary columns of RTAB-Map's tables Node and Data.
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>

#include <compare>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roomgraph/core/outcome.h"
#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph::rtabmap {

using Blob = std::span<const std::uint8_t>;

/// Of the database: Admin.version.
struct Version {
  int major = 0, minor = 0, patch = 0;
  auto operator<=>(const Version&) const = default;
};
/// "0.20.16"; nothing when it is no version.
std::optional<Version> versionOf(const std::string& text);

/// 3x4 floats, row by row. Nothing when it is empty, null (zeros), not finite or no rotation.
std::optional<Pose3> transformOf(Blob blob);

struct CameraBlob {
  PinholeCamera camera;  ///< of rectified images; width 0: that of the image
  Pose3 robot_from_optical = Pose3::Identity();
};
/// Cameras of Data.calibration, whose images stand side by side. Fails: stereo, impossible sizes, cut off.
Outcome<std::vector<CameraBlob>> camerasOf(Blob blob, const Version& version);

/// Data.depth: CV_16UC1 (mm) or CV_32FC1 (m; in the bytes of a PNG of four channels), PNG or RVL. Fails when
/// it is damaged, or not depth.
Outcome<cv::Mat> depthOf(Blob blob);

/// Data.scan with Data.scan_info: points in the frame of the scanner. Fails when they are damaged or no 2D
/// scan. The record has no time and no label.
Outcome<mrpt::obs::CObservation2DRangeScan::Ptr> scanOf(Blob scan, Blob info, const Version& version);

}  // namespace roomgraph::rtabmap
