// SPDX-License-Identifier: BSD-3-Clause
// What is in a CARMEN log, and what an import does with it.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "carmen_line.h"
#include "roomgraph/imports/carmen_import.h"

namespace roomgraph::carmen {

/// What a log holds, message by message. Memory: some numbers for each.
class Survey {
 public:
  struct Clock {
    std::vector<double> ipc, ipc_minus_logger;
    int jumps_back = 0;  ///< of the sender's clock, by more than a second
  };
  struct Scanner {
    std::size_t readings = 0;  ///< of the first sweep
    std::optional<Sweep::Angles> angles;
    float largest = 0;      ///< range that was read, m
    int times_largest = 0;  ///< how often
    std::vector<Pose2> robot_from_laser;
    std::vector<Pose2> robot;  ///< the first pose, and one that differs
  };

  void take(const Message& message);

  std::map<std::string, Clock> clocks;  ///< by name of the message
  std::map<std::string, Scanner> scanners;
  std::map<std::string, std::string> parameters;
  std::map<std::string, int> others;  ///< messages that are not read
  std::vector<Pose2> odometry;        ///< of ODOM: the first pose, and one that differs
  int true_poses = 0;

 private:
  void takeSweep(const Message& message, const Sweep& sweep);
};

struct ScannerPlan {
  Pose2 robot_from_laser;
  double max_range_m = 0;                     ///< readings from there on are no returns
  std::optional<double> field_of_view, step;  ///< rad; of messages without angles, where known
  bool corrected = false;                     ///< the laser's pose is another program's
};

struct LogPlan {
  bool by_logger = false;
  std::map<std::string, ScannerPlan> scanners;  ///< those that are used, by name of the message
  std::string odometry;                         ///< name of the message that has it; empty: none
  std::string truth;                            ///< TRUEPOS, or a sweep's name; empty: none
  std::vector<std::string> used, warnings;
};

/// Throws InputError when nothing in the log can be used; `name` begins its message.
LogPlan planLog(const Survey& survey, const CarmenImportOptions& options, const std::string& name);

/// Angles of a sweep without any, rad: symmetric over the field of view where that is known, else the half
/// circle of a SICK LMS, or what its step makes of it: an even number of readings is that without the last.
Sweep::Angles assumedAngles(const ScannerPlan& scanner, std::size_t readings);

/// From where on readings are no returns, when neither message nor user says it; m.
double maxRange(float largest, int times_largest);

}  // namespace roomgraph::carmen
