// SPDX-License-Identifier: BSD-3-Clause
// Copy of a rawlog with detection records inserted at their times.
#pragma once

#include <filesystem>
#include <memory>

#include "roomgraph/observations/CObservationDetections.h"

namespace roomgraph {

/// Copies a rawlog byte by byte (images are not compressed again) and puts detections in at their times,
/// as comments that every program of MRPT can read (toComment()). Those that the input has already are left
/// out: the new ones stand for them. External images are not copied: when the copy would look for them
/// elsewhere, a link NAME_Images to their folder is made beside it.
class RawlogCopy {
 public:
  /// Throws InputError (input missing, not a rawlog), ConfigError (the output is the input) or RunError (the
  /// output cannot be written).
  RawlogCopy(const std::filesystem::path& input, const std::filesystem::path& output);
  /// Leaves no file when finish() was not called.
  ~RawlogCopy();
  RawlogCopy(const RawlogCopy&) = delete;
  RawlogCopy& operator=(const RawlogCopy&) = delete;

  /// Copies all records older than the detections, then writes them: they come before their image, so that
  /// whoever reads the copy has them when the image comes. Calls in order of time.
  void insert(const CObservationDetections& detections);
  /// Copies the rest and gives the file its name. Throws RunError when writing failed (disk full).
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roomgraph
