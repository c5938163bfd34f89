// SPDX-License-Identifier: BSD-3-Clause
// Layouts of transforms, camera models and depth as RTAB-Map serialises them (little endian).
#include "rtabmap_blobs.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "roomgraph/datasets/picture_decoding.h"

namespace roomgraph::rtabmap {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kTransform = 12;  // floats
constexpr Version kSerialisedCameras{0, 18, 0};

template <class Number>
Number numberAt(Blob blob, std::size_t byte) {
  Number value;
  std::memcpy(&value, blob.subspan(byte, sizeof value).data(), sizeof value);
  return value;
}

bool isUsable(const PinholeCamera& camera) {
  return std::isfinite(camera.fx + camera.fy + camera.cx + camera.cy) && camera.fx > 0 && camera.fy > 0 &&
         camera.width >= 0 && camera.height >= 0 && camera.width < 1 << 16 && camera.height < 1 << 16;
}

// CameraModel: version, type, size, numbers of values in K, D, R, P and the transform; then these.
struct CameraHeader {
  std::array<std::int32_t, 11> values;
  std::int32_t type() const { return values[3]; }
  std::size_t count(std::size_t i) const { return static_cast<std::size_t>(values[6 + i]); }
};

Outcome<std::vector<CameraBlob>> serialisedCameras(Blob blob) {
  using Failure = Outcome<std::vector<CameraBlob>>;
  std::vector<CameraBlob> cameras;
  while (!blob.empty()) {
    CameraHeader header{};
    if (blob.size() < sizeof header.values) return Failure::failure("calibration is cut off");
    std::memcpy(header.values.data(), blob.data(), sizeof header.values);
    if (header.type() != 0)
      return Failure::failure(header.type() == 1 ? "stereo camera" : "calibration of an unknown type");
    const auto sized = [&](std::size_t i, std::int32_t size) {
      return header.values[6 + i] == 0 || header.values[6 + i] == size;
    };
    if (!sized(0, 9) || header.values[7] < 0 || header.values[7] > 32 || !sized(2, 9) || !sized(3, 12) ||
        !sized(4, 12))
      return Failure::failure("calibration has impossible sizes");
    const std::size_t k = sizeof header.values,
                      p = k + 8 * (header.count(0) + header.count(1) + header.count(2)),
                      transform = p + 8 * header.count(3), end = transform + 4 * header.count(4);
    if (blob.size() < end) return Failure::failure("calibration is cut off");
    CameraBlob camera;
    const auto take = [&](std::size_t at, std::array<std::size_t, 4> places) {
      camera.camera.fx = numberAt<double>(blob, at + 8 * places[0]);
      camera.camera.fy = numberAt<double>(blob, at + 8 * places[1]);
      camera.camera.cx = numberAt<double>(blob, at + 8 * places[2]);
      camera.camera.cy = numberAt<double>(blob, at + 8 * places[3]);
    };
    if (header.count(0) > 0) take(k, {0, 4, 2, 5});
    if (header.count(3) > 0 && numberAt<double>(blob, p) > 0) take(p, {0, 5, 2, 6});  // rectified
    camera.camera.width = header.values[4];
    camera.camera.height = header.values[5];
    if (!isUsable(camera.camera)) return Failure::failure("not calibrated");
    if (header.count(4) > 0) {
      const auto place = transformOf(blob.subspan(transform, 4 * kTransform));
      if (!place) return Failure::failure("the camera's place is no transform");
      camera.robot_from_optical = *place;
    }
    cameras.push_back(camera);
    blob = blob.subspan(end);
  }
  return cameras;
}

// Before 0.18: fx, fy, cx, cy, width, height and the transform of each camera as floats; stereo has one more.
Outcome<std::vector<CameraBlob>> floatCameras(Blob blob) {
  using Failure = Outcome<std::vector<CameraBlob>>;
  constexpr std::size_t kBytes = 4 * (6 + kTransform);
  if (blob.size() == kBytes + 4) return Failure::failure("stereo camera");
  if (blob.size() % kBytes != 0) return Failure::failure("calibration has an impossible size");
  std::vector<CameraBlob> cameras;
  for (; !blob.empty(); blob = blob.subspan(kBytes)) {
    const auto value = [&](std::size_t i) { return static_cast<double>(numberAt<float>(blob, 4 * i)); };
    CameraBlob camera;
    camera.camera.fx = value(0);
    camera.camera.fy = value(1);
    camera.camera.cx = value(2);
    camera.camera.cy = value(3);
    if (!(value(4) >= 0 && value(4) < 1 << 16 && value(5) >= 0 && value(5) < 1 << 16))
      return Failure::failure("not calibrated");
    camera.camera.width = static_cast<int>(value(4));
    camera.camera.height = static_cast<int>(value(5));
    const auto place = transformOf(blob.subspan(24, 4 * kTransform));
    if (!isUsable(camera.camera)) return Failure::failure("not calibrated");
    if (!place) return Failure::failure("the camera's place is no transform");
    camera.robot_from_optical = *place;
    cameras.push_back(camera);
  }
  return cameras;
}

}  // namespace

std::optional<Version> versionOf(const std::string& text) {
  Version version;
  int used = 0;
  if (std::sscanf(text.c_str(), "%d.%d.%d%n", &version.major, &version.minor, &version.patch, &used) != 3 ||
      static_cast<std::size_t>(used) != text.size())
    return std::nullopt;
  return version;
}

std::optional<Pose3> transformOf(Blob blob) {
  constexpr double kOff = 1e-2;  // products of floats
  if (blob.size() != 4 * kTransform) return std::nullopt;
  Eigen::Matrix<double, 3, 4> matrix;
  for (Eigen::Index i = 0; i < 12; ++i)
    matrix(i / 4, i % 4) = static_cast<double>(numberAt<float>(blob, 4 * static_cast<std::size_t>(i)));
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  if (!matrix.allFinite() || !(rotation * rotation.transpose()).isIdentity(kOff) ||
      rotation.determinant() < 0)
    return std::nullopt;
  Pose3 pose = Pose3::Identity();
  pose.linear() = rotation;
  pose.translation() = matrix.col(3);
  return normalized(pose);
}

Outcome<std::vector<CameraBlob>> camerasOf(Blob blob, const Version& version) {
  if (blob.empty()) return Outcome<std::vector<CameraBlob>>::failure("no calibration");
  return version >= kSerialisedCameras ? serialisedCameras(blob) : floatCameras(blob);
}

Outcome<cv::Mat> depthOf(Blob blob) {
  constexpr std::array<std::uint8_t, 8> kRvl{'D', 'E', 'P', 'T', 'H', 'R', 'V', 'L'};
  if (blob.size() > kRvl.size() && std::equal(kRvl.begin(), kRvl.end(), blob.begin()))
    return decodeRvl(blob.subspan(kRvl.size()));
  auto image = decodePicture(blob, cv::IMREAD_UNCHANGED);
  if (!image || image->type() == CV_16UC1) return image;
  if (image->type() != CV_8UC4) return Outcome<cv::Mat>::failure("is no depth image (of a stereo camera?)");
  return cv::Mat(image->rows, image->cols, CV_32FC1, image->data, image->step).clone();
}

}  // namespace roomgraph::rtabmap
