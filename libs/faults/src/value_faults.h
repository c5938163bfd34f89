// SPDX-License-Identifier: BSD-3-Clause
// Faults of measured values: no numbers, noise.
#pragma once

#include "fault.h"
#include "roomgraph/core/random.h"

namespace roomgraph {

/// Values that are no number, NaN, +infinity and -infinity in turn: a fifth of the beams of a scan, drawn at
/// random and marked as valid; a coordinate of an odometry reading; the unit of a depth image, whose pixels
/// are integers.
class NotANumberFault : public Fault {
 public:
  NotANumberFault(StruckSensors sensors, FaultWindow window, Random random)
      : sensors_(std::move(sensors)), window_(window), random_(random) {}
  PassingRecords pass(PassingRecord record) override;

 private:
  float nextValue();
  bool strike(mrpt::obs::CObservation& observation);

  StruckSensors sensors_;
  FaultWindow window_;
  Random random_;
  int struck_ = 0;
};

/// Normal noise: 0.3 m on each return of a scan, 0.1 m on each depth and 40 grey levels on each channel of a
/// picture, 0.1 m and 0.1 rad on odometry poses (not added up); all times `factor`.
class NoiseFault : public Fault {
 public:
  NoiseFault(StruckSensors sensors, FaultWindow window, double factor, Random random)
      : sensors_(std::move(sensors)), window_(window), factor_(factor), random_(random) {}
  PassingRecords pass(PassingRecord record) override;

 private:
  bool strike(mrpt::obs::CObservation& observation);

  StruckSensors sensors_;
  FaultWindow window_;
  double factor_;
  Random random_;
};

}  // namespace roomgraph
