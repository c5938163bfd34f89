// SPDX-License-Identifier: BSD-3-Clause
// Record headers of the ROS 1 bag format 2.0, and its compressed chunks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "byte_readers.h"

namespace roomgraph::bags {

/// A file read at any place, through a buffer of fixed size.
class FileWindow {
 public:
  /// Throws InputError.
  explicit FileWindow(const std::filesystem::path& file);
  ~FileWindow();
  FileWindow(const FileWindow&) = delete;
  FileWindow& operator=(const FileWindow&) = delete;

  std::uint64_t size() const { return size_; }
  /// Bytes from `offset` on, fewer than `count` where the file ends. Throws InputError when the disk fails.
  /// Valid until the next call; larger counts than the buffer make it grow, never beyond the file.
  Bytes at(std::uint64_t offset, std::size_t count);

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0, begin_ = 0;
  std::size_t filled_ = 0;
  std::vector<std::uint8_t> buffer_;
};

/// Fields of a record's header by name.
using RecordFields = std::map<std::string, std::string, std::less<>>;

/// Parts of a record's header. Nothing when the bytes are none.
std::optional<RecordFields> parseFields(Bytes bytes);
/// A field as a number; nothing when it is missing or of another size.
template <class Number>
std::optional<Number> numberIn(const RecordFields& fields, std::string_view name) {
  const auto field = fields.find(name);
  if (field == fields.end() || field->second.size() != sizeof(Number)) return std::nullopt;
  Number value;
  std::memcpy(&value, field->second.data(), sizeof value);
  return value;
}

enum RecordKind : std::uint8_t {
  kMessageRecord = 2,
  kBagRecord = 3,
  kIndexRecord = 4,
  kChunkRecord = 5,
  kChunkInfoRecord = 6,
  kConnectionRecord = 7
};

/// Content of a compressed chunk: at most `size` bytes, of which memory is taken as they come. Throws
/// BadMessage when the compression is unknown or the bytes are damaged; `out` then has what came before.
void decompress(const std::string& compression, Bytes bytes, std::size_t size,
                std::vector<std::uint8_t>& out);

}  // namespace roomgraph::bags
