// SPDX-License-Identifier: BSD-3-Clause
// MCAP files for tests, written by the format's description (mcap.dev/spec), apart from the reader.
#pragma once

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "bag_reader.h"

namespace roomgraph::test {

template <class Number>
std::string littleEndian(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
inline std::string mcapText(const std::string& text) {
  return littleEndian(static_cast<std::uint32_t>(text.size())) + text;
}
inline std::string mcapRecord(std::uint8_t opcode, const std::string& content) {
  return static_cast<char>(opcode) + littleEndian(static_cast<std::uint64_t>(content.size())) + content;
}
inline std::uint32_t checksumOf(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

struct McapOptions {
  std::string compression{};       ///< "", "lz4", "zstd"
  std::size_t chunk_bytes = 2000;  ///< 0: messages outside of chunks
  bool checksums = true, end = true, summary = false;
};

/// Writes records one after the other; bytes() is the file so far with its end.
class McapMaker {
 public:
  explicit McapMaker(const McapOptions& options) : options_(options) {
    file_ += "\x89MCAP0\r\n" + mcapRecord(0x01, mcapText("ros2") + mcapText("tests of roomgraph"));
  }

  /// Returns the id of the channel. `schema`: name of the message type, empty for a channel without one.
  std::uint16_t channel(const std::string& topic, const std::string& schema,
                        const std::string& encoding = "cdr") {
    const auto id = static_cast<std::uint16_t>(++channels_);
    const auto schema_id = static_cast<std::uint16_t>(schema.empty() ? 0 : id);
    std::string records;
    if (!schema.empty())
      records =
          mcapRecord(0x03, littleEndian(id) + mcapText(schema) + mcapText("ros2msg") + mcapText("int32 x"));
    const std::string metadata = mcapText("offered_qos_profiles") + mcapText("- history: 1");
    records += mcapRecord(0x04, littleEndian(id) + littleEndian(schema_id) + mcapText(topic) +
                                    mcapText(encoding) + mcapText(metadata));
    add(records);
    definitions_ += records;
    return id;
  }

  void message(std::uint16_t channel, std::uint64_t time_ns, const std::string& data) {
    add(mcapRecord(0x05, littleEndian(channel) + littleEndian(std::uint32_t{0}) + littleEndian(time_ns) +
                             littleEndian(time_ns) + data));
    last_ns_ = time_ns;
  }

  /// Anything, into the file itself.
  void raw(const std::string& bytes) {
    flush();
    file_ += bytes;
  }

  std::string bytes() {
    flush();
    if (!options_.end) return file_;
    const std::string data = file_ + mcapRecord(0x0f, littleEndian(std::uint32_t{0}));
    const std::uint64_t summary = options_.summary ? data.size() : 0;
    return data + (options_.summary ? definitions_ : "") +
           mcapRecord(0x02, littleEndian(summary) + std::string(12, '\0')) + "\x89MCAP0\r\n";
  }

  static std::string compressed(const std::string& content, const std::string& compression) {
    if (compression.empty()) return content;
    std::string out(compression == "lz4" ? LZ4F_compressFrameBound(content.size(), nullptr)
                                         : ZSTD_compressBound(content.size()),
                    '\0');
    out.resize(compression == "lz4"
                   ? LZ4F_compressFrame(out.data(), out.size(), content.data(), content.size(), nullptr)
                   : ZSTD_compress(out.data(), out.size(), content.data(), content.size(), 3));
    return out;
  }
  std::string chunk(const std::string& content, const std::string& compression) const {
    const std::string stored = compressed(content, compression);
    return mcapRecord(0x06, littleEndian(last_ns_) + littleEndian(last_ns_) +
                                littleEndian(static_cast<std::uint64_t>(content.size())) +
                                littleEndian(options_.checksums ? checksumOf(content) : 0u) +
                                mcapText(compression) +
                                littleEndian(static_cast<std::uint64_t>(stored.size())) + stored);
  }

 private:
  void add(const std::string& record) {
    if (options_.chunk_bytes == 0) {
      file_ += record;
      return;
    }
    content_ += record;
    if (content_.size() >= options_.chunk_bytes) flush();
  }
  void flush() {
    if (content_.empty()) return;
    file_ += chunk(content_, options_.compression);
    file_ += mcapRecord(0x07, littleEndian(std::uint16_t{1}) + littleEndian(std::uint32_t{0}));  // an index
    content_.clear();
  }

  McapOptions options_;
  std::string file_, content_, definitions_;
  int channels_ = 0;
  std::uint64_t last_ns_ = 0;
};

/// The messages of another bag as MCAP, in their order.
inline std::string mcapOf(const std::filesystem::path& bag, const McapOptions& options = {}) {
  McapMaker maker(options);
  const auto reader = bags::openBag(bag);
  std::map<std::size_t, std::uint16_t> channels;
  for (bags::RawMessage message; reader->next(message);) {
    const auto& topic = reader->topics()[message.topic];
    auto channel = channels.find(message.topic);
    if (channel == channels.end()) {
      std::string type = topic.type;
      if (message.cdr) type.replace(type.find('/'), 1, "/msg/");
      channel = channels.emplace(message.topic, maker.channel(topic.name, type, message.cdr ? "cdr" : "ros1"))
                    .first;
    }
    maker.message(channel->second, static_cast<std::uint64_t>(message.received_ns),
                  {reinterpret_cast<const char*>(message.bytes.data()), message.bytes.size()});
  }
  return maker.bytes();
}

}  // namespace roomgraph::test
