// SPDX-License-Identifier: BSD-3-Clause
// Collector of findings about a recording, and the checks that fill it.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/datasets/rawlog_report.h"

namespace roomgraph {

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

/// Collects findings about one place after the other.
class Findings {
 public:
  void at(std::string place) { place_ = std::move(place); }
  void error(const std::string& what, const std::string& hint) { add(Severity::kError, what, hint); }
  void warning(const std::string& what, const std::string& hint) { add(Severity::kWarning, what, hint); }
  void note(const std::string& what, const std::string& hint) { add(Severity::kNote, what, hint); }
  /// Worst first.
  std::vector<Finding> sorted();

 private:
  void add(Severity severity, const std::string& what, const std::string& hint) {
    list_.push_back({severity, what, place_, hint});
  }
  std::string place_;
  std::vector<Finding> list_;
};

/// Label of a sensor, or its class when it has none.
std::string nameOf(const SensorReport& sensor);

/// Stamps of a sensor: missing, equal, out of order, with gaps.
void checkTimes(const RawlogReport& report, const SensorReport& sensor, Findings& out);
/// Records that a sensor repeats.
void checkRepetition(const SensorReport& sensor, Findings& out);
/// Odometry against what a robot can do, and against the scans.
void checkOdometry(const RawlogReport& report, const SensorReport& sensor, Findings& out);
/// Images, cameras, depth unit. False when the depth unit is in doubt.
bool checkImages(const SensorReport& sensor, Findings& out);
/// The sensor's pose against the floor that its depth images see, if their unit is right. `on_robot`: the
/// recording is not that of a camera alone.
void checkPose(const SensorReport& sensor, bool on_robot, bool unit_is_right, Findings& out);
/// Sensors whose stamps are not of one clock. False when there are any.
bool checkClocks(const RawlogReport& report, Findings& out);

}  // namespace roomgraph
