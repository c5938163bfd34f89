// SPDX-License-Identifier: BSD-3-Clause
// Faults of wheels that do not turn while the robot moves.
#pragma once

#include <map>
#include <string>

#include "fault.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// Odometry of wheels that stand still at times: the pose goes on from where it stood.
class StandingWheels {
 public:
  /// The next pose that was recorded, and whether the wheels stand; returns the pose that they report.
  Pose2 report(const Pose2& recorded, bool stand);
  /// Whether reported poses differ from recorded ones by now.
  bool differs() const { return differs_; }

 private:
  Pose2 recorded_, reported_;
  bool begun_ = false, differs_ = false;
};

/// The robot is lifted or slips: odometry stands still in the window and goes on from there.
class LiftedWheelsFault : public Fault {
 public:
  explicit LiftedWheelsFault(FaultWindow window) : window_(window) {}
  PassingRecords pass(PassingRecord record) override;

 private:
  FaultWindow window_;
  std::map<std::string, StandingWheels> wheels_;  ///< by label
};

/// The robot is carried off with its sensors covered: no record in the window, of no sensor, and wheels that
/// did not turn in it.
class KidnapFault : public Fault {
 public:
  explicit KidnapFault(FaultWindow window) : window_(window), carried_(window) {}
  PassingRecords pass(PassingRecord record) override;

 private:
  FaultWindow window_;
  LiftedWheelsFault carried_;
};

}  // namespace roomgraph
