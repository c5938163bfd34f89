// SPDX-License-Identifier: BSD-3-Clause
// Topics that a reader has met, and how much of each is wanted.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bag_reader.h"

namespace roomgraph::bags {

/// rosbag2 writes "sensor_msgs/msg/Image"; BagTopic has it as in ROS 1.
std::string ros1Name(std::string type);

class TopicList {
 public:
  /// The index of the topic, which is new or as before.
  std::size_t add(const BagTopic& topic);
  /// Asked for each topic, now or when it is met; without it everything is wanted.
  void setWants(std::function<Want(const BagTopic&)> wants);
  Want wanted(std::size_t topic) const { return wanted_[topic]; }
  const std::vector<BagTopic>& topics() const { return topics_; }

 private:
  std::vector<BagTopic> topics_;
  std::vector<Want> wanted_;
  std::function<Want(const BagTopic&)> wants_;
};

}  // namespace roomgraph::bags
