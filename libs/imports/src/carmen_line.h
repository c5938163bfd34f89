// SPDX-License-Identifier: BSD-3-Clause
// Messages of a CARMEN log, one a line.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "roomgraph/core/outcome.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph::carmen {

/// "PARAM name value": a setting of the robot's programs.
struct Parameter {
  std::string name, value;
};

/// "ODOM x y theta tv rv accel": m, rad, m/s, rad/s.
struct Odometry {
  Pose2 pose;
  double forward_m_s = 0, turn_rad_s = 0;
};

/// "TRUEPOS true_x true_y true_theta odom_x odom_y odom_theta", of a simulator.
struct TruePose {
  Pose2 pose;
};

/// A sweep, counter-clockwise. FLASER and RLASER, the old form, have no angles.
struct Sweep {
  struct Angles {
    double start = 0, field_of_view = 0, step = 0;  ///< rad
    double max_range_m = 0;
  };
  std::optional<Angles> angles;
  std::vector<float> ranges;          ///< m
  std::vector<float> remissions;      ///< empty, or one for each range
  std::optional<Pose2> laser, robot;  ///< in the frame of the odometry, or corrected; RAWLASER has none
};

/// When the message was sent, by its sender's clock, and when the logger got it, s after its start.
struct Stamps {
  double ipc = 0;
  std::optional<double> logger;
};

struct Message {
  std::string name;  ///< FLASER, ODOM…; empty: a comment or an empty line
  std::variant<std::monostate, Parameter, Odometry, TruePose, Sweep> content;  ///< nothing: another message
  Stamps stamps;                                                               ///< of all but parameters
};

/// Reads PARAM, ODOM, TRUEPOS, FLASER, RLASER, and RAWLASER and ROBOTLASER with any number, in the format of
/// CARMEN's logger ("message_name [contents] ipc_timestamp ipc_hostname logger_timestamp"); of all others the
/// name only. Fails with the reason when a line is cut off or is not what its name says.
Outcome<Message> parseLine(std::string_view line);

}  // namespace roomgraph::carmen
