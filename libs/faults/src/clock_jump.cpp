// SPDX-License-Identifier: BSD-3-Clause
// Shift of stamps in whole ticks of the clock.
#include "clock_jump.h"

#include <chrono>

namespace roomgraph {

ClockJumpFault::ClockJumpFault(StruckSensors sensors, double at_s, double shift_s)
    : sensors_(std::move(sensors)),
      at_s_(at_s),
      shift_(std::chrono::round<mrpt::Clock::duration>(std::chrono::duration<double>(shift_s))) {}

PassingRecords ClockJumpFault::pass(PassingRecord record) {
  if (sensors_.contains(record.sensor) && record.t >= at_s_) {
    record.observation->timestamp += shift_;
    changed(record);
  }
  return one(std::move(record));
}

}  // namespace roomgraph
