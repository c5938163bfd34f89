// SPDX-License-Identifier: BSD-3-Clause
// Gzipped rawlog under construction, put into place when complete.
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <filesystem>
#include <memory>
#include <string_view>

namespace roomgraph {

/// A gzipped rawlog being written. It gets its name when it is whole; MRPT's own stream says nothing about a
/// disk that is full when the file is closed.
class RawlogWriter {
 public:
  /// Throws RunError naming file and cause.
  explicit RawlogWriter(const std::filesystem::path& rawlog);
  /// Removes what was written when it was not put into its place.
  ~RawlogWriter();
  RawlogWriter(RawlogWriter&&) noexcept;
  RawlogWriter& operator=(RawlogWriter&&) noexcept;

  void write(const mrpt::serialization::CSerializable& record);
  /// A record as it stands in another rawlog.
  void write(std::string_view bytes);
  /// Closes the file: all of it is on the disk. Throws RunError naming file and cause.
  void close();
  /// Puts the file, which has been closed, into its place. Throws RunError.
  void commit();
  /// Both.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roomgraph
