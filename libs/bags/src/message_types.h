// SPDX-License-Identifier: BSD-3-Clause
// Fields and checksums of the message types that are written.
#pragma once

#include <string>

namespace roomgraph::bags {

struct MessageType {
  std::string name;        ///< "sensor_msgs/Image"
  std::string md5;         ///< by which ROS programs know that they mean the same
  std::string definition;  ///< fields of the type, then those of all types in it
};

/// Throws std::out_of_range for a type that is never written.
const MessageType& messageType(const std::string& name);

}  // namespace roomgraph::bags
