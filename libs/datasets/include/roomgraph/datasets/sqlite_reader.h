// SPDX-License-Identifier: BSD-3-Clause
// Reading of recordings that are SQLite files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace roomgraph {

/// A database file, opened for reading only, and its running query. Also one whose writer was killed.
class SqliteReader {
 public:
  enum class Step { kRow, kDone, kFailed };

  /// `complaint`: what is said of a file that cannot be read, "is no bag of ROS 2, or damaged". Throws
  /// InputError: file, complaint, cause.
  SqliteReader(const std::filesystem::path& file, std::string complaint);
  ~SqliteReader();
  SqliteReader(const SqliteReader&) = delete;
  SqliteReader& operator=(const SqliteReader&) = delete;

  /// Begins a query. Throws InputError.
  void ask(const std::string& sql);
  Step step();
  bool isNull(int column) const;
  std::int64_t integer(int column) const;
  double real(int column) const;
  std::string text(int column) const;
  /// Valid until the next step.
  std::span<const std::uint8_t> blob(int column) const;
  std::string cause() const;  ///< of the last failure
  [[noreturn]] void fail() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roomgraph
