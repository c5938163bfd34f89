// SPDX-License-Identifier: BSD-3-Clause
// Bags of ROS 1 and ROS 2, and single messages in them.
#include "../target.h"
#include "image_decoding.h"
#include "roomgraph/bags/bag_import.h"

namespace roomgraph::fuzz {
namespace {

ROOMGRAPH_FUZZ_TARGET(bag_ros1) {
  const auto bag = scratchFile("x.bag", bytes);
  listBag(bag);
  importBag(bag, scratchFolder() / "bag.rawlog");
}

ROOMGRAPH_FUZZ_TARGET(bag_ros2) {
  const auto bag = scratchFile("x.db3", bytes);
  listBag(bag);
  importBag(bag, scratchFolder() / "bag.rawlog");
}

ROOMGRAPH_FUZZ_TARGET(bag_mcap) {
  const auto bag = scratchFile("x.mcap", bytes);
  listBag(bag);
  importBag(bag, scratchFolder() / "bag.rawlog");
}

template <class Message>
void decodeMessage(const bags::RawMessage& message) {
  bags::decode<Message>(message);
}

void decodeImage(const bags::RawMessage& message, bool compressed) {
  const auto image = bags::imageOf(message, compressed);
  if (bags::contentOf(image.encoding) == bags::ImageContent::kDepth)
    bags::depthImageOf(image, compressed);
  else
    bags::colorImageOf(image, compressed);
}

// The first byte chooses the type, and the serialisation by its highest bit; the message follows.
ROOMGRAPH_FUZZ_TARGET(bag_message) {
  using Decode = void (*)(const bags::RawMessage&);
  static constexpr Decode kTypes[] = {[](const bags::RawMessage& m) { decodeImage(m, false); },
                                      [](const bags::RawMessage& m) { decodeImage(m, true); },
                                      decodeMessage<bags::CameraInfoMessage>,
                                      decodeMessage<bags::LaserScanMessage>,
                                      decodeMessage<bags::OdometryMessage>,
                                      decodeMessage<bags::PoseMessage>,
                                      decodeMessage<bags::TransformsMessage>,
                                      decodeMessage<bags::ImuMessage>};
  if (bytes.empty()) return;
  const auto first = static_cast<unsigned char>(bytes.front());
  bags::RawMessage message;
  message.cdr = first & 0x80;
  message.bytes = {reinterpret_cast<const std::uint8_t*>(bytes.data()) + 1, bytes.size() - 1};
  try {
    kTypes[first % std::size(kTypes)](message);
  } catch (const bags::BadMessage&) {
    // The import counts it.
  }
}

}  // namespace
}  // namespace roomgraph::fuzz
