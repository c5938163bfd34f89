// SPDX-License-Identifier: BSD-3-Clause
// Rawlogs and records for the data set tests.
#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "temporary_folder.h"

namespace roomgraph::test {

using Object = mrpt::serialization::CSerializable::Ptr;

inline void writeRawlog(const std::filesystem::path& file, const std::vector<Object>& objects,
                        bool gz = true) {
  const auto write = [&](auto& stream) {
    auto archive = mrpt::serialization::archiveFrom(stream);
    for (const auto& object : objects) archive << *object;
  };
  if (gz) {
    mrpt::io::CFileGZOutputStream stream(file.string());
    write(stream);
  } else {
    mrpt::io::CFileOutputStream stream(file.string());
    write(stream);
  }
}

inline std::string bytesOf(const Object& object) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << *object;
  return {static_cast<const char*>(stream.getRawBufferData()),
          static_cast<std::size_t>(stream.getTotalBytesCount())};
}

inline std::string readBytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void writeBytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

inline mrpt::obs::CObservation2DRangeScan::Ptr makeScan(double t, float range = 2, int beams = 5) {
  auto scan = mrpt::obs::CObservation2DRangeScan::Create();
  scan->timestamp = mrpt::Clock::fromDouble(t);
  scan->sensorLabel = "LASER";
  scan->aperture = 2;
  scan->rightToLeft = true;
  scan->maxRange = 8;
  scan->resizeScan(static_cast<std::size_t>(beams));
  for (int i = 0; i < beams; ++i) {
    scan->setScanRange(static_cast<std::size_t>(i), range + 0.1f * static_cast<float>(i));
    scan->setScanRangeValidity(static_cast<std::size_t>(i), true);
  }
  return scan;
}

inline mrpt::obs::CObservationOdometry::Ptr makeOdometry(double t, double x, double y, double yaw) {
  auto odometry = mrpt::obs::CObservationOdometry::Create();
  odometry->timestamp = mrpt::Clock::fromDouble(t);
  odometry->sensorLabel = "ODOMETRY";
  odometry->odometry = {x, y, yaw};
  return odometry;
}

/// A small RGB-D record: a colour gradient, depth 1 m + 10 mm per column, one invalid pixel at (0, 0).
inline mrpt::obs::CObservation3DRangeScan::Ptr makeImages(double t, int width = 16, int height = 12) {
  auto images = mrpt::obs::CObservation3DRangeScan::Create();
  images->timestamp = mrpt::Clock::fromDouble(t);
  images->sensorLabel = "KINECT";
  images->hasRangeImage = true;
  images->rangeUnits = 0.001f;
  images->rangeImage_setSize(height, width);
  images->hasIntensityImage = true;
  images->intensityImage.resize(static_cast<std::size_t>(width), static_cast<std::size_t>(height),
                                mrpt::img::CH_RGB);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      images->rangeImage(v, u) = static_cast<std::uint16_t>(u == 0 && v == 0 ? 0 : 1000 + 10 * u);
      // Smooth in u, so that JPEG keeps it; B < G < R tells the order of the channels.
      images->intensityImage.setPixel(u, v, mrpt::img::TColor(200, 100 + u, 20));
    }
  images->cameraParams.ncols = static_cast<std::uint32_t>(width);
  images->cameraParams.nrows = static_cast<std::uint32_t>(height);
  images->cameraParams.setIntrinsicParamsFromValues(20, 20, (width - 1) / 2.0, (height - 1) / 2.0);
  images->cameraParamsIntensity = images->cameraParams;
  return images;
}

inline mrpt::obs::CActionCollection::Ptr makeAction(double t, double x, double y, double yaw) {
  mrpt::obs::CActionRobotMovement2D movement;
  movement.computeFromOdometry({x, y, yaw}, {});
  movement.timestamp = t < 0 ? INVALID_TIMESTAMP : mrpt::Clock::fromDouble(t);
  auto actions = mrpt::obs::CActionCollection::Create();
  actions->insert(movement);
  return actions;
}

inline mrpt::obs::CSensoryFrame::Ptr makeSensoryFrame(
    const std::vector<mrpt::obs::CObservation::Ptr>& observations) {
  auto frame = mrpt::obs::CSensoryFrame::Create();
  for (const auto& observation : observations) frame->insert(observation);
  return frame;
}

/// Bytes of a sensory frame whose first observation, a scan, MRPT wrote as a null pointer.
inline std::string withNull(const mrpt::obs::CSensoryFrame::Ptr& frame) {
  std::string bytes = bytesOf(frame);
  const std::string scan = bytesOf(frame->getObservationByIndex(0));
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive.WriteObject(nullptr);
  const std::string null(static_cast<const char*>(stream.getRawBufferData()),
                         static_cast<std::size_t>(stream.getTotalBytesCount()));
  return bytes.replace(bytes.find(scan), scan.size(), null);
}

}  // namespace roomgraph::test
