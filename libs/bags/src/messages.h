// SPDX-License-Identifier: BSD-3-Clause
// Messages of ROS as plain structs, and their decoding from a record of a bag.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "byte_readers.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph::bags {

/// A record of a bag. `bytes` are those of its reader, until that goes on.
struct RawMessage {
  std::size_t topic = 0;         ///< index among the reader's topics
  std::int64_t received_ns = 0;  ///< when the recorder got it
  bool cdr = false;              ///< ROS 2; else the serialisation of ROS 1
  Bytes bytes;                   ///< perhaps only the beginning, see BagReader::wants()
};

struct MessageHeader {
  std::int64_t stamp_ns = 0;  ///< 0: the driver has set none
  std::string frame;          ///< without the slash that old programs put before it
};

/// sensor_msgs/Image and CompressedImage up to the pixels.
struct ImageHead {
  MessageHeader header;
  std::uint32_t width = 0, height = 0, step = 0;  ///< px, px, bytes; 0 in a compressed image
  bool big_endian = false;
  std::string encoding;  ///< of a compressed image its format
};
struct ImageMessage : ImageHead {
  Bytes data;
};

/// sensor_msgs/CameraInfo. Matrices row by row.
struct CameraInfoMessage {
  MessageHeader header;
  std::uint32_t width = 0, height = 0;
  std::string distortion_model;
  std::vector<double> distortion;
  std::array<double, 9> k{}, r{};
  std::array<double, 12> p{};
  std::uint32_t binning_x = 0, binning_y = 0;
  std::uint32_t roi_x = 0, roi_y = 0, roi_width = 0,
                roi_height = 0;  ///< before binning; width 0: the whole image
};

/// sensor_msgs/LaserScan: rad, s, m.
struct LaserScanMessage {
  MessageHeader header;
  float angle_min = 0, angle_max = 0, angle_increment = 0, time_increment = 0, scan_time = 0;
  float range_min = 0, range_max = 0;
  std::vector<float> ranges, intensities;
};

/// nav_msgs/Odometry without the covariances.
struct OdometryMessage {
  MessageHeader header;
  std::string child_frame;
  Pose3 pose = Pose3::Identity();
  std::array<double, 6> twist{};  ///< linear (m/s), angular (rad/s) in the child frame
};

/// geometry_msgs/PoseStamped.
struct PoseMessage {
  MessageHeader header;
  Pose3 pose = Pose3::Identity();
};

/// geometry_msgs/TransformStamped: parent (header.frame) from child.
struct TransformMessage {
  MessageHeader header;
  std::string child_frame;
  Pose3 parent_from_child = Pose3::Identity();
};
struct TransformsMessage {
  std::vector<TransformMessage> transforms;
  std::vector<std::string>
      faults;  ///< of those that cannot be used and are left out: "base -> gps: quaternion …"
};

/// sensor_msgs/Imu: orientation (x, y, z, w), rad/s, m/s^2. A first covariance of -1 says that there is none.
struct ImuMessage {
  MessageHeader header;
  std::array<double, 4> orientation{};
  std::array<double, 3> angular_velocity{}, linear_acceleration{};
  bool has_orientation = false, has_angular_velocity = false, has_linear_acceleration = false;
};

/// Header of a message whose type begins with one.
MessageHeader headerOf(const RawMessage& message);
ImageHead imageHeadOf(const RawMessage& message, bool compressed);
ImageMessage imageOf(const RawMessage& message, bool compressed);

/// Each throws BadMessage when the bytes do not make such a message. A message needs no more memory than a
/// small multiple of its bytes.
template <class Message>
Message decode(const RawMessage& message);

}  // namespace roomgraph::bags
