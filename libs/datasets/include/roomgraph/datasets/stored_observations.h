// SPDX-License-Identifier: BSD-3-Clause
// StoredObservationReader: all observations of a rawlog, sound or not, with the bytes they stand there with.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace roomgraph {

/// An observation of a rawlog and how it stands there.
struct StoredObservation {
  mrpt::obs::CObservation::Ptr observation;
  /// Serialised, for an unchanged copy; empty when it was part of a larger record (sensory frame, action) or
  /// had its images in files.
  std::string bytes;
};

/// Streams the observations of a rawlog (either format, plain or gzipped) in the order of the file for a copy
/// of them, whereas ObservationReader leaves out what cannot be used. Impossible values and missing stamps
/// come out as they are; only what MRPT cannot parse is left out and counted. Odometry of action records is
/// summed up and comes out as CObservationOdometry; without a stamp it takes that of the observation after
/// it. External images are loaded and put into the observation, unless their file is missing.
class StoredObservationReader {
 public:
  /// Throws InputError (missing, empty, not a rawlog) naming the file and the cause.
  explicit StoredObservationReader(const std::filesystem::path& file);
  ~StoredObservationReader();
  StoredObservationReader(StoredObservationReader&&) noexcept;
  StoredObservationReader& operator=(StoredObservationReader&&) noexcept;

  /// Nothing at the end of the file.
  std::optional<StoredObservation> next();
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
