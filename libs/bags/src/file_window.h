// SPDX-License-Identifier: BSD-3-Clause
// Buffered reading of a file at any place.
#pragma once

#include <cstdint>
#include <filesystem>
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

}  // namespace roomgraph::bags
