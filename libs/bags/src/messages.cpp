// SPDX-License-Identifier: BSD-3-Clause
// Fields of each message type in their order, read alike from ROS 1 and from CDR bytes.
//
// Why not the message packages: those of ROS 1 cannot read CDR, Debian has none of ROS 2, and both allocate
// by lengths that they do not check. The order of the fields is the same in both worlds but for the header,
// so one list does.
#include "messages.h"

#include <cmath>

namespace roomgraph::bags {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

std::string withoutSlash(std::string frame) {
  if (frame.starts_with('/')) frame.erase(0, 1);
  return frame;
}

template <class In>
void read(In& in, MessageHeader& header) {
  if constexpr (In::kRos1) in.template number<std::uint32_t>();  // seq
  // Seconds are unsigned in ROS 1; stamps of this century have the same bits in both.
  const auto seconds = in.template number<std::int32_t>();
  header.stamp_ns = seconds * kSecond + in.template number<std::uint32_t>();
  header.frame = withoutSlash(in.text());
}

template <class Number, class In, std::size_t n>
void read(In& in, std::array<Number, n>& numbers) {
  for (auto& number : numbers) number = in.template number<Number>();
}

template <class Number, class In>
void readSequence(In& in, std::vector<Number>& numbers) {
  const std::size_t count = in.template number<std::uint32_t>();
  if (count > in.left() / sizeof(Number)) throw BadMessage("ends too early");
  numbers.reserve(count);
  for (std::size_t i = 0; i < count; ++i) numbers.push_back(in.template number<Number>());
}

Pose3 poseOf(const std::array<double, 7>& v) {
  Pose3 pose = Pose3::Identity();
  pose.translation() = Eigen::Vector3d(v[0], v[1], v[2]);
  Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (!pose.translation().allFinite() || !std::isfinite(q.norm())) throw BadMessage("pose is not finite");
  if (std::abs(q.norm() - 1) > 0.1) throw BadMessage("quaternion is not of length 1");
  pose.linear() = q.normalized().toRotationMatrix();
  return pose;
}

template <class In>
Pose3 readPose(In& in) {
  std::array<double, 7> numbers;
  read(in, numbers);
  return poseOf(numbers);
}

template <class In>
void read(In& in, ImageHead& image, bool compressed) {
  read(in, image.header);
  if (compressed) {
    image.encoding = in.text();
    return;
  }
  image.height = in.template number<std::uint32_t>();
  image.width = in.template number<std::uint32_t>();
  image.encoding = in.text();
  image.big_endian = in.template number<std::uint8_t>() != 0;
  image.step = in.template number<std::uint32_t>();
}

template <class In>
void read(In& in, CameraInfoMessage& info) {
  read(in, info.header);
  info.height = in.template number<std::uint32_t>();
  info.width = in.template number<std::uint32_t>();
  info.distortion_model = in.text();
  readSequence(in, info.distortion);
  read(in, info.k);
  read(in, info.r);
  read(in, info.p);
  info.binning_x = in.template number<std::uint32_t>();
  info.binning_y = in.template number<std::uint32_t>();
  info.roi_x = in.template number<std::uint32_t>();
  info.roi_y = in.template number<std::uint32_t>();
  info.roi_height = in.template number<std::uint32_t>();
  info.roi_width = in.template number<std::uint32_t>();
  in.template number<std::uint8_t>();  // do_rectify: whether the rectified images show the same region; they
                                       // do
}

template <class In>
void read(In& in, LaserScanMessage& scan) {
  read(in, scan.header);
  for (float* value : {&scan.angle_min, &scan.angle_max, &scan.angle_increment, &scan.time_increment,
                       &scan.scan_time, &scan.range_min, &scan.range_max})
    *value = in.template number<float>();
  readSequence(in, scan.ranges);
  readSequence(in, scan.intensities);
}

template <class In>
void read(In& in, OdometryMessage& odometry) {
  read(in, odometry.header);
  odometry.child_frame = withoutSlash(in.text());
  odometry.pose = readPose(in);
  std::array<double, 36> covariance;
  read(in, covariance);
  read(in, odometry.twist);
}

template <class In>
void read(In& in, PoseMessage& pose) {
  read(in, pose.header);
  pose.pose = readPose(in);
}

template <class In>
void read(In& in, TransformsMessage& message) {
  constexpr std::size_t kLeastBytes = 7 * sizeof(double);
  const std::size_t count = in.template number<std::uint32_t>();
  if (count > in.left() / kLeastBytes) throw BadMessage("ends too early");
  for (std::size_t i = 0; i < count; ++i) {
    TransformMessage transform;
    read(in, transform.header);
    transform.child_frame = withoutSlash(in.text());
    std::array<double, 7> numbers;
    read(in, numbers);
    // One publisher's transform that nobody has set costs the others in its message nothing.
    try {
      transform.parent_from_child = poseOf(numbers);
      message.transforms.push_back(std::move(transform));
    } catch (const BadMessage& error) {
      message.faults.push_back(transform.header.frame + " -> " + transform.child_frame + ": " + error.what());
    }
  }
}

template <class In>
void read(In& in, ImuMessage& imu) {
  std::array<double, 9> covariance;
  const auto known = [&] {
    read(in, covariance);
    return covariance[0] != -1;
  };
  read(in, imu.header);
  read(in, imu.orientation);
  imu.has_orientation = known();
  read(in, imu.angular_velocity);
  imu.has_angular_velocity = known();
  read(in, imu.linear_acceleration);
  imu.has_linear_acceleration = known();
}

// Calls `use` with the reader of the message's serialisation.
template <class Use>
auto withReader(const RawMessage& message, Use&& use) {
  if (message.cdr) {
    CdrReader in(message.bytes);
    return use(in);
  }
  Ros1Reader in(message.bytes);
  return use(in);
}

}  // namespace

MessageHeader headerOf(const RawMessage& message) {
  return withReader(message, [](auto& in) {
    MessageHeader header;
    read(in, header);
    return header;
  });
}

ImageHead imageHeadOf(const RawMessage& message, bool compressed) {
  return withReader(message, [&](auto& in) {
    ImageHead head;
    read(in, head, compressed);
    return head;
  });
}

ImageMessage imageOf(const RawMessage& message, bool compressed) {
  return withReader(message, [&](auto& in) {
    ImageMessage image;
    read(in, image, compressed);
    image.data = in.take(in.template number<std::uint32_t>());
    return image;
  });
}

template <class Message>
Message decode(const RawMessage& message) {
  return withReader(message, [](auto& in) {
    Message out;
    read(in, out);
    return out;
  });
}

template CameraInfoMessage decode(const RawMessage&);
template LaserScanMessage decode(const RawMessage&);
template OdometryMessage decode(const RawMessage&);
template PoseMessage decode(const RawMessage&);
template TransformsMessage decode(const RawMessage&);
template ImuMessage decode(const RawMessage&);

}  // namespace roomgraph::bags
