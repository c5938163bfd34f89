// SPDX-License-Identifier: BSD-3-Clause
// OutputFolder: a set of result files published together under a lock.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace roomgraph {

/// A folder of results that belong together. They are written into `FOLDER/roomgraph_unfinished` and moved into place
/// when all are complete, so FOLDER holds the former results or the new ones, never a mixture. It is locked meanwhile
/// (the lock ends with the process). Files left by a killed process are removed by the next one; if it was killed while
/// files were being moved, the next one completes that.
class OutputFolder {
 public:
  /// Makes and locks the folder. `names`: every file that such a command may write, the one that says that
  /// all are there last. Throws RunError: cannot be made or written, one of the names is a folder, or another
  /// process uses it; ConfigError: one of the inputs would be replaced or removed.
  OutputFolder(const std::filesystem::path& folder, std::vector<std::string> names,
               const std::vector<std::filesystem::path>& inputs = {});
  /// Removes what was not published.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where it will be in the end.
  const std::filesystem::path& folder() const { return folder_; }
  /// Where to write the file `name`, which is one of the names.
  std::filesystem::path pending(const std::string& name) const;
  /// Where to put what lets another process go on with this work. Nothing is done to it before publish().
  std::filesystem::path checkpoint() const { return folder_ / "roomgraph_checkpoint"; }
  /// Throws RunError when the folder is no longer where it was: what is written would be lost.
  void requireInPlace() const;
  /// Puts all files into place, the last name last; removes those of the names that were not written this
  /// time, and the checkpoint, unless it is to be kept. Before that the last one of the former results goes:
  /// without it a folder is not whole. Signals that end a program are ignored meanwhile. Throws RunError.
  void publish(bool keep_checkpoint = false);

 private:
  void protect(const std::filesystem::path& input) const;
  void lock();
  void settle();

  std::filesystem::path folder_, unfinished_;
  std::vector<std::string> names_;
  int lock_ = -1;
};

}  // namespace roomgraph
