// SPDX-License-Identifier: BSD-3-Clause
// Databases in the layout of RTAB-Map, written column by column, and imports of them.
#pragma once

#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <sqlite3.h>
#include <zlib.h>

#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "rawlog_records.h"
#include "roomgraph/geometry/pose.h"
#include "roomgraph/imports/rtabmap_import.h"
#include "temporary_folder.h"

namespace roomgraph::test {

using Column = std::vector<std::uint8_t>;

template <class Number>
void append(Column& bytes, const std::vector<Number>& values) {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(values.data());
  bytes.insert(bytes.end(), begin, begin + values.size() * sizeof(Number));
}

/// 3x4 floats.
inline Column transformBytes(const Pose3& pose) {
  Column bytes;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      append<float>(bytes, {static_cast<float>(pose.matrix()(row, column))});
  return bytes;
}

/// CameraModel of 0.18 and later: K, perhaps P, and the place of the optical frame. `type` 1: stereo.
inline Column cameraBytes(int width, int height, double f, double cx, double cy,
                          const Pose3& robot_from_optical, double rectified_f = 0, int type = 0) {
  Column bytes;
  append<std::int32_t>(bytes, {0, 20, 16, type, width, height, 9, 5, 0, rectified_f > 0 ? 12 : 0, 12});
  append<double>(bytes, {f, 0, cx, 0, f, cy, 0, 0, 1});
  append<double>(bytes, {0.1, 0, 0, 0, 0});
  if (rectified_f > 0) append<double>(bytes, {rectified_f, 0, cx, 0, 0, rectified_f, cy, 0, 0, 0, 1, 0});
  const Column place = transformBytes(robot_from_optical);
  bytes.insert(bytes.end(), place.begin(), place.end());
  return bytes;
}

/// Before 0.18: floats.
inline Column oldCameraBytes(int width, int height, float f, float cx, float cy,
                             const Pose3& robot_from_optical) {
  Column bytes;
  append<float>(bytes, {f, f, cx, cy, static_cast<float>(width), static_cast<float>(height)});
  const Column place = transformBytes(robot_from_optical);
  bytes.insert(bytes.end(), place.begin(), place.end());
  return bytes;
}

inline Column encoded(const cv::Mat& image, const std::string& ending = ".png") {
  Column bytes;
  if (!cv::imencode(ending, image, bytes)) throw std::runtime_error("no encoder");
  return bytes;
}

/// Metres in the bytes of a picture of four channels.
inline Column floatDepthBytes(const cv::Mat& metres) {
  return encoded(cv::Mat(metres.rows, metres.cols, CV_8UC4, metres.data));
}

/// Points of `channels` floats each, by zlib, then rows, columns and type of the matrix.
inline Column scanBytes(const std::vector<float>& values, int channels) {
  uLongf size = compressBound(values.size() * sizeof(float));
  Column bytes(size);
  compress(bytes.data(), &size, reinterpret_cast<const Bytef*>(values.data()), values.size() * sizeof(float));
  bytes.resize(size);
  append<std::int32_t>(
      bytes, {1, static_cast<std::int32_t>(values.size()) / channels, CV_MAKETYPE(CV_32F, channels)});
  return bytes;
}

/// From 0.18 on.
inline Column scanInfoBytes(float format, float max_range, float angle_min, float angle_max, float step,
                            const Pose3& robot_from_scanner) {
  Column bytes;
  append<float>(bytes, {format, 0, max_range, angle_min, angle_max, step, 0});
  const Column place = transformBytes(robot_from_scanner);
  bytes.insert(bytes.end(), place.begin(), place.end());
  return bytes;
}

/// A row of Node and one of Data; empty columns are null.
struct NodeRow {
  int id = 1, session = 0;
  double stamp = 1.7e9;
  Column pose, truth, image, depth, calibration, scan, scan_info;
};

inline void run(sqlite3* database, const std::string& sql, const std::vector<Column>& blobs = {}) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr) != SQLITE_OK)
    throw std::runtime_error(sqlite3_errmsg(database));
  for (std::size_t i = 0; i < blobs.size(); ++i)
    if (!blobs[i].empty())
      sqlite3_bind_blob(statement, static_cast<int>(i) + 1, blobs[i].data(),
                        static_cast<int>(blobs[i].size()), SQLITE_TRANSIENT);
  const int state = sqlite3_step(statement);
  sqlite3_finalize(statement);
  if (state != SQLITE_DONE) throw std::runtime_error(sqlite3_errmsg(database));
}

/// The tables and columns of version 0.20 that an import reads, among others that it does not.
inline std::filesystem::path writeDatabase(const std::filesystem::path& file,
                                           const std::vector<NodeRow>& rows,
                                           const std::string& version = "0.20.16") {
  sqlite3* database = nullptr;
  sqlite3_open(file.c_str(), &database);
  run(database,
      "CREATE TABLE Node (id INTEGER NOT NULL, map_id INTEGER NOT NULL, weight INTEGER, stamp FLOAT, pose "
      "BLOB, "
      "ground_truth_pose BLOB, velocity BLOB, label TEXT, gps BLOB, env_sensors BLOB, time_enter DATE, "
      "PRIMARY KEY (id))");
  run(database,
      "CREATE TABLE Data (id INTEGER NOT NULL, image BLOB, depth BLOB, calibration BLOB, scan BLOB, "
      "scan_info BLOB, "
      "ground_cells BLOB, user_data BLOB, time_enter DATE, PRIMARY KEY (id))");
  run(database, "CREATE TABLE Admin (version TEXT, preview_image BLOB, time_enter DATE)");
  run(database, "INSERT INTO Admin(version) VALUES('" + version + "')");
  run(database, "BEGIN");
  for (const auto& row : rows) {
    char stamp[40];
    std::snprintf(stamp, sizeof stamp, "%.6f", row.stamp);
    run(database,
        "INSERT INTO Node(id, map_id, weight, stamp, pose, ground_truth_pose) VALUES(" +
            std::to_string(row.id) + ", " + std::to_string(row.session) + ", 0, " + stamp + ", ?, ?)",
        {row.pose, row.truth});
    run(database,
        "INSERT INTO Data(id, image, depth, calibration, scan, scan_info) VALUES(" + std::to_string(row.id) +
            ", ?, ?, ?, ?, ?)",
        {row.image, row.depth, row.calibration, row.scan, row.scan_info});
  }
  run(database, "COMMIT");
  sqlite3_close(database);
  return file;
}

/// A database of these rows, imported.
struct ImportedDatabase {
  explicit ImportedDatabase(const std::vector<NodeRow>& rows, const RtabmapImportOptions& options = {},
                            const std::string& version = "0.20.16") {
    result =
        importRtabmap(writeDatabase(folder.file("x.db"), rows, version), folder.file("x.rawlog"), options);
    records = recordsIn(folder.file("x.rawlog"));
  }
  TemporaryFolder folder;
  RtabmapImportResult result;
  std::vector<mrpt::obs::CObservation::Ptr> records;
};

/// robot_from_optical of a camera at a place, looking along the robot's x axis.
inline Pose3 opticalAt(double x, double y, double z) {
  Pose3 pose = poseFromYpr(x, y, z, 0, 0, 0);
  pose.linear() = bodyFromOptical();
  return pose;
}

/// 16x12 px: colour (20 + v, 100 + u, 200), depth 1000 + 10 u mm and none at (0, 0); camera of f 20 at (0.2,
/// 0, 0.8).
inline NodeRow smallNode(int id = 1, double t = 1.7e9) {
  cv::Mat color(12, 16, CV_8UC3), depth(12, 16, CV_16UC1);
  for (int v = 0; v < 12; ++v)
    for (int u = 0; u < 16; ++u) {
      color.at<cv::Vec3b>(v, u) =
          cv::Vec3b(static_cast<std::uint8_t>(20 + v), static_cast<std::uint8_t>(100 + u), 200);
      depth.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(u == 0 && v == 0 ? 0 : 1000 + 10 * u);
    }
  NodeRow row{id, 0, t, transformBytes(poseFromYpr(0.1 * id, 0, 0, 0.01 * id, 0, 0))};
  row.image = encoded(color);
  row.depth = encoded(depth);
  row.calibration = cameraBytes(16, 12, 20, 7.5, 5.5, opticalAt(0.2, 0, 0.8));
  return row;
}

}  // namespace roomgraph::test
