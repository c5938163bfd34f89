// SPDX-License-Identifier: BSD-3-Clause
// Journal: a file of records that only grows, of which a sound beginning outlives whatever ends the program.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace roomgraph {

/// A file of records, read from its beginning and then continued. Each record has a checksum over itself and
/// all before it, so that what a kill, a power cut or a full disk leaves is a beginning of what was written,
/// and known as such.
class Journal {
 public:
  /// Opens the file, or makes it. `key`: what the records belong to; under another key none of them can be
  /// read. Throws RunError naming file and cause.
  Journal(std::filesystem::path file, std::string_view key);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The next record; nothing at the end, or where the first damaged one begins. Throws RunError (read
  /// error).
  std::optional<std::string> next();
  /// The record that next() gave last counts as not given.
  void unread();
  /// Bytes of the file that no sound record holds, after next() gave nothing.
  std::uintmax_t damagedBytes() const { return size_ - end_; }

  /// Adds a record behind those that next() gave; whatever the file holds behind them is cut off. It outlives
  /// the program at once, the machine after sync(). Throws RunError (full disk …); the records before stay.
  void append(std::string_view record);
  /// Waits until all records are on the disk. Throws RunError.
  void sync();

  /// Bytes of the records read and written.
  std::uintmax_t bytes() const { return end_; }

 private:
  std::string checksumOf(std::string_view record) const;
  bool read(std::uintmax_t from, char* out, std::size_t count) const;
  void write(std::string_view bytes);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::string last_;  ///< checksum of the last record read or written; of the key before the first
  std::uintmax_t size_ = 0, end_ = 0;  ///< of the file; of its records read or written
  std::string last_before_;            ///< both of the moment before next() was called
  std::uintmax_t end_before_ = 0;
};

}  // namespace roomgraph
