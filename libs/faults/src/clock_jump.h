// SPDX-License-Identifier: BSD-3-Clause
// Fault of a clock that is set while a recording goes on.
#pragma once

#include "fault.h"

namespace roomgraph {

/// From `at_s` on the stamps are `shift_s` later, or earlier when it is negative.
class ClockJumpFault : public Fault {
 public:
  ClockJumpFault(StruckSensors sensors, double at_s, double shift_s);
  PassingRecords pass(PassingRecord record) override;

 private:
  StruckSensors sensors_;
  double at_s_;
  mrpt::Clock::duration shift_;
};

}  // namespace roomgraph
