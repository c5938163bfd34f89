// SPDX-License-Identifier: BSD-3-Clause
// ObservationReader: all observations of a rawlog as they were recorded, of whatever sensor.
#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "roomgraph/core/outcome.h"
#include "roomgraph/observations/frame.h"

namespace roomgraph {

/// Streams the observations of a rawlog (either format, plain or gzipped), in the order of the file: what a
/// conversion to another format needs, whereas RawlogReader yields what a run uses. Odometry of action
/// records comes out as CObservationOdometry. What is broken or impossible is left out and counted.
class ObservationReader {
 public:
  /// Throws InputError (missing, empty, not a rawlog) naming the file and the cause.
  explicit ObservationReader(const std::filesystem::path& file);
  ~ObservationReader();
  ObservationReader(ObservationReader&&) noexcept;
  ObservationReader& operator=(ObservationReader&&) noexcept;

  /// The next observation with a time stamp, images loaded; null at the end of the file.
  mrpt::obs::CObservation::Ptr next();
  /// An RGB-D observation of this rawlog as a run sees it: undistorted, depth registered to colour, m. The
  /// reason says why there is none.
  Outcome<Frame> frameOf(mrpt::obs::CObservation3DRangeScan& observation) const;
  /// Whether colour and depth of the observation have one camera in common.
  static bool isRegistered(const mrpt::obs::CObservation3DRangeScan& observation);
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
