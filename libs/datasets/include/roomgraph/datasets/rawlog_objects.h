// SPDX-License-Identifier: BSD-3-Clause
// RawlogObjects: the serialised objects of a rawlog as they stand there.
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace roomgraph {

/// Streams the objects of a rawlog (actions, sensory frames, observations, comments; plain or gzipped) in the
/// order of the file. What MRPT cannot parse is left out and counted.
class RawlogObjects {
 public:
  /// Throws InputError (missing, empty, not a rawlog) naming the file and the cause.
  explicit RawlogObjects(const std::filesystem::path& file);
  ~RawlogObjects();

  /// The next object; null at the end of the file.
  mrpt::serialization::CSerializable::Ptr next();
  /// Share of the file read, [0, 1].
  double progress() const;
  /// Records left out, by reason.
  const std::map<std::string, int>& skipped() const;
  /// Of a truncated file: the cause with the byte offset; else empty.
  const std::string& truncation() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roomgraph
