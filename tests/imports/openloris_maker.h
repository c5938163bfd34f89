// SPDX-License-Identifier: BSD-3-Clause
// Folders in the layout of OpenLORIS-Scene, written of a rawlog, and imports of them.
#pragma once

#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "rawlog_records.h"
#include "roomgraph/geometry/pose.h"
#include "roomgraph/imports/openloris_import.h"
#include "temporary_folder.h"

namespace roomgraph::test {

/// An OpenCV matrix in YAML, row by row.
inline std::string yamlMatrix(const std::string& name, int rows, int cols,
                              const std::vector<double>& values) {
  std::string text = "      " + name + ": !!opencv-matrix\n         rows: " + std::to_string(rows) +
                     "\n         cols: " + std::to_string(cols) + "\n         dt: d\n         data: [ ";
  for (std::size_t i = 0; i < values.size(); ++i) {
    char number[40];
    std::snprintf(number, sizeof number, "%s%.16e", i > 0 ? ", " : "", values[i]);
    text += number;
  }
  return text + " ]\n";
}

inline std::string yamlTransform(const std::string& parent, const std::string& child,
                                 const Pose3& parent_from_child) {
  std::vector<double> values;
  for (int i = 0; i < 16; ++i) values.push_back(parent_from_child.matrix()(i / 4, i % 4));
  return "   -\n      parent_frame: " + parent + "\n      child_frame: " + child + "\n" +
         yamlMatrix("matrix", 4, 4, values);
}

inline std::string sensorsYaml(int width, int height, double f, double cx, double cy,
                               const std::string& model = "radial-tangential", double k1 = 0) {
  return "%YAML:1.0\n---\nd400_color_optical_frame:\n      sensor_type: camera\n      sensor_name: "
         "d400_color_optical_frame\n      fps: 30\n"
         "      width: " +
         std::to_string(width) + "\n      height: " + std::to_string(height) + "\n      model: pinhole\n" +
         yamlMatrix("intrinsics", 1, 4, {f, cx, f, cy}) + "      distortion_model: " + model + "\n" +
         yamlMatrix("distortion_coefficients", 1, 5, {k1, 0, 0, 0, 0}) +
         "odometer:\n      sensor_type: odometer\n      sensor_name: odometer\n";
}

/// The images and the odometry of a rawlog as a sequence; depth images come 7 us after colour.
inline std::filesystem::path writeSequence(const TemporaryFolder& folder,
                                           const std::vector<mrpt::obs::CObservation::Ptr>& records,
                                           double odometry_offset_s = 0) {
  const auto place = folder.file("room1-1");
  std::filesystem::create_directories(place / "color");
  std::filesystem::create_directories(place / "aligned_depth");
  std::string color = "#timestamp filename\n", depth = color,
              odometry = "#Time px py pz qx qy qz qw vx vy vz wx wy wz\n", truth = "#t x y z qx qy qz qw\n";
  char line[400];
  std::shared_ptr<mrpt::obs::CObservation3DRangeScan> camera;
  for (const auto& record : records) {
    const double t = secondsOf(*record);
    if (const auto wheels = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(record)) {
      const auto& pose = wheels->odometry;
      std::snprintf(line, sizeof line, "%.6f %.9f %.9f 0 0 0 %.9f %.9f %.6f %.6f 0 0 0 %.6f\n",
                    t + odometry_offset_s, pose.x(), pose.y(), std::sin(pose.phi() / 2),
                    std::cos(pose.phi() / 2), wheels->velocityLocal.vx, wheels->velocityLocal.vy,
                    wheels->velocityLocal.omega);
      odometry += line;
      std::snprintf(line, sizeof line, "%.6f %.9f %.9f 0 0 0 0 1\n", t, pose.x(), pose.y());
      truth += line;
    }
    const auto images = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(record);
    if (!images) continue;
    camera = images;
    std::snprintf(line, sizeof line, "%.6f", t);
    const std::string color_name = "color/" + std::string(line) + ".png";
    color += std::string(line) + " " + color_name + "\n";
    std::snprintf(line, sizeof line, "%.6f", t + 7e-6);
    const std::string depth_name = "aligned_depth/" + std::string(line) + ".png";
    depth += std::string(line) + " " + depth_name + "\n";
    cv::imwrite((place / color_name).string(),
                images->intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY));
    cv::imwrite((place / depth_name).string(),
                cv::Mat(static_cast<int>(images->rangeImage.rows()),
                        static_cast<int>(images->rangeImage.cols()), CV_16UC1, images->rangeImage.data()));
  }
  const auto& k = camera->cameraParamsIntensity;
  Pose3 forward_from_optical = Pose3::Identity();
  forward_from_optical.linear() = bodyFromOptical();
  // Through a frame on the way, as the IMU and the depth camera have it there.
  const Pose3 robot_from_link = poseFromYpr(0.3, -0.1, 0.5, 0.2, 0.1, -0.1);
  const Pose3 link_from_optical =
      robot_from_link.inverse() * toPose3(camera->sensorPose) * forward_from_optical;
  folder.write("room1-1/color.txt", color);
  folder.write("room1-1/aligned_depth.txt", depth);
  folder.write("room1-1/odom.txt", odometry);
  folder.write("room1-1/groundtruth.txt", truth);
  folder.write("room1-1/sensors.yaml",
               sensorsYaml(static_cast<int>(k.ncols), static_cast<int>(k.nrows), k.fx(), k.cx(), k.cy()));
  folder.write("room1-1/trans_matrix.yaml",
               "%YAML:1.0\n---\ntrans_matrix:\n" +
                   yamlTransform("d400_link", "d400_color_optical_frame", link_from_optical) +
                   yamlTransform("base_link", "d400_link", robot_from_link) +
                   yamlTransform("base_link", "laser", Pose3::Identity()));
  return place;
}

}  // namespace roomgraph::test
