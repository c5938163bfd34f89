// SPDX-License-Identifier: BSD-3-Clause
// BagReader: the records of a bag of ROS 1 or ROS 2, one after the other.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "messages.h"

namespace roomgraph::bags {

struct BagTopic {
  std::string name;
  std::string type;  ///< as ROS 1 writes it: "sensor_msgs/Image"
};

/// How much of a topic's messages is asked for.
enum class Want { kNothing, kBeginning, kAll };
/// What Want::kBeginning gives at least, if the message has as much: header and encoding of an image.
inline constexpr std::size_t kBeginningBytes = 512;

/// Streams a bag in the order of its recording with memory for one chunk, whatever its length. What is broken
/// is stepped over and told by problems().
class BagReader {
 public:
  virtual ~BagReader() = default;
  /// The next message of a topic that is wanted; false at the end.
  virtual bool next(RawMessage& message) = 0;
  /// Topics met so far; a bag without an index names them as they come.
  virtual const std::vector<BagTopic>& topics() const = 0;
  /// Asked once for each topic; without it everything is wanted.
  virtual void wants(std::function<Want(const BagTopic&)> wants) = 0;
  /// Share of the bag that was read, [0, 1].
  virtual double progress() const = 0;
  /// What is wrong with the bag, one line each: "no index …", "ends early …". Complete at the end.
  virtual const std::vector<std::string>& problems() const = 0;
};

/// Opens a bag by what is in it: a .bag of ROS 1, a .db3 or .mcap of ROS 2, or the folder of one. Throws
/// InputError naming the file and why it cannot be read.
std::unique_ptr<BagReader> openBag(const std::filesystem::path& bag);

/// The files that are read of the bag.
std::vector<std::filesystem::path> filesOfBag(const std::filesystem::path& bag);

}  // namespace roomgraph::bags
