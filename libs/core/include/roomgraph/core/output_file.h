// SPDX-License-Identifier: BSD-3-Clause
// Output files checked for write errors and replaced atomically; outputs that are inputs refused.
#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

namespace roomgraph {

/// A text file being written that reports a full disk, unlike a plain stream.
class OutputFile : public std::ofstream {
 public:
  /// Makes or empties the file. Throws RunError naming file and cause.
  explicit OutputFile(std::filesystem::path file);
  /// Throws RunError naming file and cause when something written so far failed.
  void check();
  /// Flushes, checks and closes.
  void finish();

 private:
  std::filesystem::path file_;
};

/// A file that is written under a temporary name in the same folder and then replaces its target atomically: after any
/// failure the target has its former content, or all of the new one.
class PendingFile {
 public:
  /// Reserves the temporary name. Throws RunError: the folder cannot be written, the place is a folder or a
  /// device, or another process is writing the same file.
  explicit PendingFile(const std::filesystem::path& place);
  /// Removes the temporary file unless it was put into place.
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Where to write.
  const std::filesystem::path& path() const { return temporary_; }
  /// Puts the file, which has been closed, into its place. Throws RunError.
  void commit();

 private:
  std::filesystem::path place_, temporary_;
  int lock_ = -1;
};

/// Writes all of a file at once, by way of a PendingFile; what is not a regular file (a pipe, /dev/stdout) is
/// written directly. Throws RunError naming file and cause.
void writeFileAtomically(const std::filesystem::path& file, std::string_view bytes);

/// Throws ConfigError when `output` is one of the inputs, under whatever name.
void requireOther(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs);

/// Waits until the file is on the disk: some file systems find only then that it is full. Throws RunError.
void flushToDisk(const std::filesystem::path& file);

/// "cannot write FILE: CAUSE", the cause being that of `error` (errno).
[[noreturn]] void failToWrite(const std::filesystem::path& file, int error);

}  // namespace roomgraph
