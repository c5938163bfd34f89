// SPDX-License-Identifier: BSD-3-Clause
// Topics by name and type.
#include "topic_list.h"

#include <algorithm>

namespace roomgraph::bags {

std::string ros1Name(std::string type) {
  if (const auto middle = type.find("/msg/"); middle != type.npos) type.replace(middle, 5, "/");
  return type;
}

std::size_t TopicList::add(const BagTopic& topic) {
  const auto known = std::find_if(topics_.begin(), topics_.end(), [&](const BagTopic& other) {
    return other.name == topic.name && other.type == topic.type;
  });
  const auto index = static_cast<std::size_t>(known - topics_.begin());
  if (known == topics_.end()) {
    topics_.push_back(topic);
    wanted_.push_back(wants_ ? wants_(topic) : Want::kAll);
  }
  return index;
}

void TopicList::setWants(std::function<Want(const BagTopic&)> wants) {
  wants_ = std::move(wants);
  for (std::size_t i = 0; i < topics_.size(); ++i) wanted_[i] = wants_(topics_[i]);
}

}  // namespace roomgraph::bags
