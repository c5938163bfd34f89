// SPDX-License-Identifier: BSD-3-Clause
// Faults of whole records: lost, repeated, doubled, out of order.
#pragma once

#include <optional>

#include "fault.h"

namespace roomgraph {

/// The sensors give nothing.
class DropFault : public Fault {
 public:
  DropFault(StruckSensors sensors, FaultWindow window) : sensors_(std::move(sensors)), window_(window) {}
  PassingRecords pass(PassingRecord record) override;

 private:
  StruckSensors sensors_;
  FaultWindow window_;
};

/// The sensor hangs: the last record before the window, or else the first one in it, comes again and again
/// with new stamps.
class FreezeFault : public Fault {
 public:
  FreezeFault(FaultySensor sensor, FaultWindow window) : sensor_(sensor), window_(window) {}
  PassingRecords pass(PassingRecord record) override;

 private:
  FaultySensor sensor_;
  FaultWindow window_;
  std::map<std::string, PassingRecord> last_;  ///< by label
};

/// Records come twice in a row, with one stamp.
class DuplicateFault : public Fault {
 public:
  DuplicateFault(StruckSensors sensors, FaultWindow window) : sensors_(std::move(sensors)), window_(window) {}
  PassingRecords pass(PassingRecord record) override;

 private:
  StruckSensors sensors_;
  FaultWindow window_;
};

/// Of two records in a row the later one stands first in the file.
class SwapFault : public Fault {
 public:
  SwapFault(StruckSensors sensors, FaultWindow window) : sensors_(std::move(sensors)), window_(window) {}
  PassingRecords pass(PassingRecord record) override;
  PassingRecords finish() override;

 private:
  StruckSensors sensors_;
  FaultWindow window_;
  std::optional<PassingRecord> held_;
};

}  // namespace roomgraph
