// SPDX-License-Identifier: BSD-3-Clause
// Import of logs of CARMEN (Carnegie Mellon Robot Navigation Toolkit) as rawlogs.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/datasets/sensor_poses.h"

namespace roomgraph {

/// Which clock gives the records their times.
enum class CarmenTimes {
  kSender,  ///< ipc_timestamp: when the message was sent; the logger's where these do not advance
  kLogger,  ///< logger_timestamp: when the logger got it, s after its start
};

struct CarmenImportOptions {
  CarmenTimes times = CarmenTimes::kSender;
  std::optional<double> field_of_view;  ///< of FLASER and RLASER, rad, from the first beam to the last
  std::optional<double> max_range_m;    ///< of all scanners; readings from there on are no returns
  SensorPoses sensor_poses;             ///< robot_from_sensor by label, instead of what the log says
  bool corrected_as_truth = false;  ///< the corrected poses in FLASER of a log that another program improved
};

struct CarmenImportResult {
  std::map<std::string, int> written;  ///< records by label
  std::map<std::string, int> skipped;  ///< messages left out by reason
  std::vector<std::string> used;       ///< "FLASER: 180 beams over 180.0 deg, less than 81.83 m"
  std::filesystem::path ground_truth;  ///< file written; empty when there is none
  std::string truth;                   ///< what it is
  std::vector<std::string> warnings;
};

/// Writes a log (plain or gzipped) as an observation-only rawlog in order of time: CObservation2DRangeScan of
/// ROBOTLASER1…, else of FLASER and RLASER, else of RAWLASER1…, labelled by these names;
/// CObservationOdometry, label ODOMETRY, of ODOM or of the robot's poses in the sweeps, whichever there are
/// more of. The log is read twice.
///
/// Angles of FLASER are an option, else in steps of PARAM laser_front_laser_resolution, else those of a SICK
/// LMS 2xx: from -90 degrees on in steps of 180 degrees divided by the number of readings, or by one less
/// where that is odd. Places of
/// scanners are the median of laser's against robot's pose, else PARAM robot_frontlaser_offset. Where that
/// median is far from single values, another program has corrected the former poses: they are not used, but
/// as ground truth when the options say so. TRUEPOS of a simulator is ground truth.
///
/// Readings from the largest range on are no returns: the option's, that of the message, else what a SICK
/// LMS 2xx reports instead of a range when the log's largest is one of these, else the log's largest when it
/// occurs five times or more.
///
/// What is broken is left out, counted and told. Throws InputError (no log, nothing usable in it),
/// ConfigError (a place to write that is read) or RunError (output cannot be written).
CarmenImportResult importCarmen(const std::filesystem::path& log, const std::filesystem::path& rawlog,
                                const CarmenImportOptions& options = {},
                                const std::function<void(double share)>& progress = nullptr);

}  // namespace roomgraph
