// SPDX-License-Identifier: BSD-3-Clause
// Messages of ROS 1 made from observations of MRPT, as bytes.
#pragma once

#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "roomgraph/geometry/pose.h"

namespace roomgraph::bags {

/// parent_from_child of tf.
struct FrameLink {
  std::string parent, child;
  Pose3 parent_from_child = Pose3::Identity();
};

/// CV_8UC3 (BGR), CV_8UC1, CV_16UC1 or CV_32FC1.
std::string imageBytes(const cv::Mat& image, std::int64_t t_ns, const std::string& frame);
std::string cameraInfoBytes(const mrpt::img::TCamera& camera, std::int64_t t_ns, const std::string& frame);
/// Beams without a return are infinitely far (REP 117).
std::string scanBytes(const mrpt::obs::CObservation2DRangeScan& scan, std::int64_t t_ns,
                      const std::string& frame);
std::string odometryBytes(const mrpt::obs::CObservationOdometry& odometry, std::int64_t t_ns,
                          const std::string& frame, const std::string& child);
std::string imuBytes(const mrpt::obs::CObservationIMU& imu, std::int64_t t_ns, const std::string& frame);
std::string poseBytes(const Pose3& pose, std::int64_t t_ns, const std::string& frame);
std::string transformsBytes(const std::vector<FrameLink>& links, std::int64_t t_ns);

}  // namespace roomgraph::bags
