// SPDX-License-Identifier: BSD-3-Clause
// Conventions of MRPT turned into those of ROS, field by field.
#include "message_writing.h"

#include <array>
#include <limits>

#include "byte_writer.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/observations/mrpt_camera.h"

namespace roomgraph::bags {
namespace {

constexpr std::size_t kCovariance = 36;

std::string encodingOf(const cv::Mat& image) {
  switch (image.type()) {
    case CV_8UC3:
      return "bgr8";
    case CV_8UC1:
      return "mono8";
    case CV_16UC1:
      return "16UC1";
    case CV_32FC1:
      return "32FC1";
    default:
      throw RunError("an image has a type for which ROS has no encoding");
  }
}

}  // namespace

std::string imageBytes(const cv::Mat& image, std::int64_t t_ns, const std::string& frame) {
  const auto step = static_cast<std::uint32_t>(static_cast<std::size_t>(image.cols) * image.elemSize());
  ByteWriter out;
  out.header(t_ns, frame);
  out.put(static_cast<std::uint32_t>(image.rows), static_cast<std::uint32_t>(image.cols))
      .text(encodingOf(image));
  out.put(std::uint8_t{0}, step, static_cast<std::uint32_t>(image.rows) * step);
  for (int v = 0; v < image.rows; ++v) out.raw({reinterpret_cast<const char*>(image.ptr(v)), step});
  return out.take();
}

std::string cameraInfoBytes(const mrpt::img::TCamera& mrpt_camera, std::int64_t t_ns, const std::string& frame) {
  const PinholeCamera camera = toPinhole(mrpt_camera);
  const Distortion lens = distortionOf(mrpt_camera);
  ByteWriter out;
  out.header(t_ns, frame);
  out.put(static_cast<std::uint32_t>(camera.height), static_cast<std::uint32_t>(camera.width))
      .text(lens.model);
  out.put(static_cast<std::uint32_t>(lens.coefficients.size()));
  for (const double d : lens.coefficients) out.put(d);
  out.put(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0);
  out.put(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
  out.put(camera.fx, 0.0, camera.cx, 0.0, 0.0, camera.fy, camera.cy, 0.0, 0.0, 0.0, 1.0, 0.0);
  out.fill(std::uint32_t{0}, 2);                       // binning
  out.fill(std::uint32_t{0}, 4).put(std::uint8_t{0});  // region of interest: all
  return out.take();
}

std::string scanBytes(const mrpt::obs::CObservation2DRangeScan& scan, std::int64_t t_ns,
                      const std::string& frame) {
  const std::size_t count = scan.getScanSize();
  const float half = (scan.rightToLeft ? 0.5f : -0.5f) * scan.aperture;
  const float step = count > 1 ? 2 * half / static_cast<float>(count - 1) : 0.f;
  ByteWriter out;
  out.header(t_ns, frame);
  out.put(-half, half, step, 0.f, 0.f, 0.f, scan.maxRange, static_cast<std::uint32_t>(count));
  for (std::size_t i = 0; i < count; ++i)
    out.put(scan.getScanRangeValidity(i) ? scan.getScanRange(i) : std::numeric_limits<float>::infinity());
  out.put(static_cast<std::uint32_t>(scan.hasIntensity() ? count : 0));
  for (std::size_t i = 0; scan.hasIntensity() && i < count; ++i)
    out.put(static_cast<float>(scan.getScanIntensity(i)));
  return out.take();
}

std::string odometryBytes(const mrpt::obs::CObservationOdometry& odometry, std::int64_t t_ns,
                          const std::string& frame, const std::string& child) {
  const auto& p = odometry.odometry;
  const auto& v = odometry.velocityLocal;
  const double unknown = odometry.hasVelocities ? 0 : std::numeric_limits<double>::quiet_NaN();
  ByteWriter out;
  out.header(t_ns, frame).text(child);
  out.pose(toPose3(Pose2{p.x(), p.y(), p.phi()})).fill(0.0, kCovariance);
  out.put(v.vx + unknown, v.vy + unknown, 0.0, 0.0, 0.0, v.omega + unknown).fill(0.0, kCovariance);
  return out.take();
}

std::string imuBytes(const mrpt::obs::CObservationIMU& imu, std::int64_t t_ns, const std::string& frame) {
  using namespace mrpt::obs;
  ByteWriter out;
  out.header(t_ns, frame);
  const auto add = [&](auto... which) {
    const bool there = (imu.has(which) && ...);
    (out.put(there ? imu.get(which) : 0.0), ...);
    out.put(there ? 0.0 : -1.0).fill(0.0, 8);  // -1: not measured
  };
  add(IMU_ORI_QUAT_X, IMU_ORI_QUAT_Y, IMU_ORI_QUAT_Z, IMU_ORI_QUAT_W);
  add(IMU_WX, IMU_WY, IMU_WZ);
  add(IMU_X_ACC, IMU_Y_ACC, IMU_Z_ACC);
  return out.take();
}

std::string poseBytes(const Pose3& pose, std::int64_t t_ns, const std::string& frame) {
  return ByteWriter().header(t_ns, frame).pose(pose).take();
}

std::string transformsBytes(const std::vector<FrameLink>& links, std::int64_t t_ns) {
  ByteWriter out;
  out.put(static_cast<std::uint32_t>(links.size()));
  for (const auto& link : links) out.header(t_ns, link.parent).text(link.child).pose(link.parent_from_child);
  return out.take();
}

}  // namespace roomgraph::bags
