// SPDX-License-Identifier: BSD-3-Clause
// Located views through MRPT's archives.
#include "view_bytes.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/stl_serialization.h>

#include <stdexcept>

#include "roomgraph/observations/growing_reads.h"

namespace roomgraph::tracking {

using mrpt::serialization::archiveFrom;

namespace {

constexpr std::size_t kPoseNumbers = 16, kCovarianceNumbers = 36;

// Ids of points are indices: half the bytes will do.
std::vector<std::uint32_t> shortened(const std::vector<std::int64_t>& ids) {
  std::vector<std::uint32_t> out;
  for (const auto id : ids) out.push_back(static_cast<std::uint32_t>(id));
  return out;
}

}  // namespace

std::string bytesOf(const LocatedView& view) {
  std::vector<float> pixels;
  for (const auto& feature : view.features.places) pixels.insert(pixels.end(), {feature.pt.x, feature.pt.y});
  const double* pose = view.odom_from_camera.data();
  const double* covariance = view.covariance.data();
  mrpt::io::CMemoryStream memory;
  auto out = archiveFrom(memory);
  out << pixels << view.features.depth << shortened(view.points) << shortened(view.in_view);
  out << std::vector<double>(pose, pose + kPoseNumbers) << std::vector<double>(covariance, covariance + kCovarianceNumbers);
  out << view.inliers << view.matches << view.reference << view.reference_inliers;
  return {static_cast<const char*>(memory.getRawBufferData()),
          static_cast<std::size_t>(memory.getTotalBytesCount())};
}

LocatedView locatedView(const std::string& bytes) {
  LocatedView view;
  mrpt::io::CMemoryStream memory;
  memory.assignMemoryNotOwn(bytes.data(), bytes.size());
  auto in = archiveFrom(memory);
  const auto pixels = readGrowing<std::vector<float>>(in);
  view.features.depth = readGrowing<std::vector<float>>(in);
  const auto points = readGrowing<std::vector<std::uint32_t>>(in), in_view = readGrowing<std::vector<std::uint32_t>>(in);
  const auto pose = readGrowing<std::vector<double>>(in), covariance = readGrowing<std::vector<double>>(in);
  in >> view.inliers >> view.matches >> view.reference >> view.reference_inliers;
  if (pixels.size() != 2 * points.size() || view.features.depth.size() != points.size() || pose.size() != kPoseNumbers ||
      covariance.size() != kCovarianceNumbers)
    throw std::invalid_argument("its lists do not have the same length");
  for (std::size_t i = 0; i + 1 < pixels.size(); i += 2)
    view.features.places.push_back({cv::Point2f(pixels[i], pixels[i + 1])});
  view.points.assign(points.begin(), points.end());
  view.in_view.assign(in_view.begin(), in_view.end());
  view.odom_from_camera.matrix() = Eigen::Map<const Eigen::Matrix4d>(pose.data());
  view.covariance = Eigen::Map<const Matrix6d>(covariance.data());
  return view;
}

}  // namespace roomgraph::tracking
