// SPDX-License-Identifier: BSD-3-Clause
// Progress in a file, for a program that watches this one.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

namespace roomgraph {

/// A file with the share that is done, in [0, 1], as one line of fixed length ("0.4321"), written anew five
/// times a second at most: whoever reads it never sees half a number. Results do not depend on it, and it
/// never fails: a file that cannot be written stays as it is.
class ProgressFile {
 public:
  /// `file` empty: none.
  explicit ProgressFile(const std::filesystem::path& file);
  ~ProgressFile();
  ProgressFile(const ProgressFile&) = delete;
  ProgressFile& operator=(const ProgressFile&) = delete;

  void update(double share);

 private:
  void write(double share) const;
  int descriptor_ = -1;
  std::chrono::steady_clock::time_point last_;
};

/// What such a file says; nothing: not there, or no share.
std::optional<double> readProgress(const std::filesystem::path& file);

}  // namespace roomgraph
