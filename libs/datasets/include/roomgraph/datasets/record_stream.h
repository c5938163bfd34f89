// SPDX-License-Identifier: BSD-3-Clause
// Sensor records of a run, and the interface of whatever yields them.
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "roomgraph/observations/CObservationDetections.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// One usable record of a sensor.
using Record = std::variant<Frame, Scan, OdometryReading, std::shared_ptr<CObservationDetections>>;

/// Time of a record, s.
double timeOf(const Record& record);

/// Yields records roughly in order of time: a rawlog, the driver of a sensor, a test. Records of different sensors
/// may be out of order by [pipeline] lookahead_s.
class RecordStream {
 public:
  virtual ~RecordStream() = default;
  /// The next record; nothing at the end.
  virtual std::optional<Record> next() = 0;
  /// Share of the stream that was read, [0, 1]; 0 where nobody knows how long it is.
  virtual double progress() const { return 0; }
};

}  // namespace roomgraph
