// SPDX-License-Identifier: BSD-3-Clause
// Records of the MCAP container, version 0 (mcap.dev/spec): an opcode, a length of 64 bits, and the content.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "byte_readers.h"

namespace roomgraph::bags {

inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
inline constexpr std::size_t kMcapRecordHead = 9, kMcapFooterBytes = 20;
/// What mcapChunkHead() wants to see, at most.
inline constexpr std::size_t kMcapChunkHeadMost = 128;

enum McapOpcode : std::uint8_t {
  kMcapFooter = 2,
  kMcapSchema = 3,
  kMcapChannel = 4,
  kMcapMessage = 5,
  kMcapChunk = 6,
  kMcapDataEnd = 15
};

struct McapSchema {
  std::uint16_t id = 0;
  std::string name;  ///< of the message type
};

struct McapChannel {
  std::uint16_t id = 0, schema = 0;  ///< the latter 0: none
  std::string topic, encoding;       ///< the latter of messages: "cdr", "ros1"
};

struct McapMessageHead {
  static constexpr std::size_t kBytes = 22;
  std::uint16_t channel = 0;
  std::uint64_t log_time_ns = 0;
};

struct McapChunkHead {
  std::uint64_t uncompressed_bytes = 0;
  std::uint32_t crc = 0;  ///< of the uncompressed content; 0: not known
  std::string compression;
  std::uint64_t head_bytes = 0, stored_bytes = 0;  ///< where the stored content begins, and its length
};

// Each takes the content of its record and throws BadMessage when that is too short.
McapSchema mcapSchema(Bytes content);
McapChannel mcapChannel(Bytes content);
McapMessageHead mcapMessageHead(Bytes content);
/// Of the beginning of a chunk's content.
McapChunkHead mcapChunkHead(Bytes beginning);

}  // namespace roomgraph::bags
