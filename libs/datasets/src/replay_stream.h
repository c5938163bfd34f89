// SPDX-License-Identifier: BSD-3-Clause
// Forward stream of a plain or gzipped file that can be rewound to a mark.
#pragma once

#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace roomgraph {

/// Bytes of a plain or gzipped file, read forward, with the way back to a mark: a record that turns out to be
/// broken can be read again byte by byte.
class ReplayStream : public mrpt::serialization::CArchive {
 public:
  /// Throws InputError when the file cannot be opened or is empty; everything else that reads throws RunError
  /// when the system cannot (a broken disk, a lost network).
  explicit ReplayStream(const std::filesystem::path& file);

  /// Uncompressed offset of the next byte.
  std::uint64_t position() const { return base_ + cursor_; }
  /// Forgets everything before the current position.
  void mark();
  /// Goes to an offset not before the mark, inside what was read so far.
  void rewind(std::uint64_t position) { cursor_ = static_cast<std::size_t>(position - base_); }
  /// `count` bytes from `position` on, or nullptr when the file ends before.
  const std::uint8_t* peek(std::uint64_t position, std::size_t count);
  /// True when no byte is left.
  bool atEnd() { return peek(position(), 1) == nullptr; }
  /// True when a read since the last mark met the end of the data.
  bool metEnd() const { return met_end_; }
  /// Why the data ended early: a broken or cut gzip stream; empty when the file ends properly.
  const std::string& damage() const { return damage_; }
  std::uint64_t fileSize() const { return file_size_; }
  /// Offset in the (compressed) file up to which it has been read.
  std::uint64_t filePosition() const;

 protected:
  std::size_t write(const void*, std::size_t) override;
  std::size_t read(void* out, std::size_t count) override;

 private:
  bool fetch();
  [[noreturn]] void failToRead(int error);
  struct Close {
    void operator()(gzFile file) const { gzclose(file); }
  };
  std::string name_, read_error_;
  std::unique_ptr<gzFile_s, Close> file_;
  std::uint64_t file_size_ = 0;
  std::vector<std::uint8_t> bytes_;  ///< from the mark on (or a little before)
  std::uint64_t base_ = 0;           ///< offset of bytes_[0]
  std::size_t cursor_ = 0;
  bool ended_ = false, met_end_ = false;
  std::string damage_;
};

}  // namespace roomgraph
