// SPDX-License-Identifier: BSD-3-Clause
// PartialFile: a file that grows beside its place and is put there when it is whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace roomgraph {

/// A file being fetched: NAME.part, kept from one attempt to the next.
class PartialFile {
 public:
  static std::filesystem::path nameFor(const std::filesystem::path& place);

  /// Opens what a former attempt left, or a new file. Throws RunError.
  explicit PartialFile(const std::filesystem::path& place);
  /// What was fetched stays; a file without a byte goes.
  ~PartialFile();
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t bytes() const { return bytes_; }
  /// Throws RunError naming file and cause, for instance a full disk.
  void append(std::string_view bytes);
  /// Forgets all bytes. Throws RunError.
  void clear();
  /// Waits until all is on the disk and gives the file its name. Throws RunError.
  void commit();

 private:
  std::filesystem::path place_, path_;
  int descriptor_ = -1;
  std::uint64_t bytes_ = 0;
};

}  // namespace roomgraph
