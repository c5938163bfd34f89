// SPDX-License-Identifier: BSD-3-Clause
// Choice of clock, sweeps, odometry and truth; places and largest ranges of scanners.
#include "carmen_survey.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/order_statistics.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph::carmen {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

void noteMovement(std::vector<Pose2>& poses, const Pose2& pose) {
  const auto differs = [&](const Pose2& first) {
    return std::abs(first.x - pose.x) + std::abs(first.y - pose.y) + std::abs(first.yaw - pose.yaw) > 1e-6;
  };
  if (poses.empty() || (poses.size() == 1 && differs(poses[0]))) poses.push_back(pose);
}

std::optional<double> parameterOf(const std::map<std::string, std::string>& parameters,
                                  const std::string& name) {
  const auto found = parameters.find(name);
  double value = 0;
  if (found == parameters.end()) return std::nullopt;
  const auto& text = found->second;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<double> stepOf(const std::map<std::string, std::string>& parameters, bool front,
                             std::size_t readings) {
  const auto degrees =
      parameterOf(parameters, front ? "laser_front_laser_resolution" : "laser_rear_laser_resolution");
  if (!degrees || !(*degrees > 0) || *degrees * static_cast<double>(readings) > 361) return std::nullopt;
  return *degrees * kDegree;
}

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::set<std::string> namesThatBegin(const Survey& survey, const std::vector<std::string>& stems) {
  std::set<std::string> names;
  for (const auto& [name, scanner] : survey.scanners)
    for (const auto& stem : stems)
      if (name.starts_with(stem)) names.insert(name);
  return names;
}

// The form that knows most of the sweeps that a log has twice.
std::set<std::string> sweepsToUse(const Survey& survey) {
  for (const auto& stems : {std::vector<std::string>{"ROBOTLASER"}, {"FLASER", "RLASER"}})
    if (auto names = namesThatBegin(survey, stems); !names.empty()) return names;
  return namesThatBegin(survey, {"RAWLASER"});
}

bool advances(const Survey& survey) {
  double low = 1e300, high = -1e300;
  std::size_t count = 0;
  for (const auto& [name, clock] : survey.clocks)
    for (const double t : clock.ipc) {
      low = std::min(low, t);
      high = std::max(high, t);
      ++count;
    }
  return count < 2 || high - low > 1e-3;
}

void planTimes(const Survey& survey, const CarmenImportOptions& options, const std::string& name,
               LogPlan& plan) {
  constexpr double kOff_s = 0.2, kDrift_s = 0.1;
  const bool has_logger = std::any_of(survey.clocks.begin(), survey.clocks.end(), [](const auto& clock) {
    return !clock.second.ipc_minus_logger.empty();
  });
  plan.by_logger = options.times == CarmenTimes::kLogger;
  if (plan.by_logger && !has_logger)
    throw ConfigError(name + ": has no logger_timestamp, only the senders' times");
  if (!plan.by_logger && !advances(survey)) {
    if (!has_logger) throw InputError(name + ": all messages have the same time stamp");
    plan.by_logger = true;
    plan.warnings.push_back("ipc_timestamp does not advance: logger_timestamp, from 0 on, is used");
  }
  std::vector<double> usual;
  for (const auto& [kind, clock] : survey.clocks)
    if (!clock.ipc_minus_logger.empty()) usual.push_back(median(clock.ipc_minus_logger));
  for (const auto& [kind, clock] : survey.clocks) {
    if (clock.jumps_back > 0 && !plan.by_logger)
      plan.warnings.push_back(kind + ": the clock jumps back by more than a second " +
                              std::to_string(clock.jumps_back) + " times; --times logger does without it");
    const auto& delays = clock.ipc_minus_logger;
    if (delays.empty() || plan.by_logger) continue;
    const double off = median(delays) - median(usual);
    if (std::abs(off) > kOff_s)
      plan.warnings.push_back(kind + ": clock is " + formatted("%.2f s", std::abs(off)) +
                              (off < 0 ? " behind" : " ahead of") +
                              " those of the other messages (against the logger's); --times logger does "
                              "without it");
    const auto quarter = static_cast<std::ptrdiff_t>(delays.size() / 4);
    const double drift =
        median({delays.end() - quarter, delays.end()}) - median({delays.begin(), delays.begin() + quarter});
    if (quarter > 0 && std::abs(drift) > kDrift_s)
      plan.warnings.push_back(kind + ": clock drifts by " + formatted("%.2f s", drift) +
                              " against the logger's from the first to the last quarter");
  }
}

// Median of the steps from robot to laser; nothing when single ones are far from it.
std::optional<Pose2> fixedStep(const std::vector<Pose2>& steps) {
  constexpr double kShare = 0.95, kDistance_m = 0.03, kAngle = 0.02;
  std::vector<double> x, y, c, s;
  for (const auto& step : steps) {
    x.push_back(step.x);
    y.push_back(step.y);
    c.push_back(std::cos(step.yaw));
    s.push_back(std::sin(step.yaw));
  }
  const Pose2 middle{median(x), median(y), std::atan2(median(s), median(c))};
  std::vector<double> off;
  for (const auto& step : steps)
    off.push_back(std::max(std::hypot(step.x - middle.x, step.y - middle.y) / kDistance_m,
                           std::abs(wrapAngle(step.yaw - middle.yaw)) / kAngle));
  if (quantile(off, kShare) > 1) return std::nullopt;
  return middle;
}

Pose2 placeOf(const std::string& name, const Survey& survey, ScannerPlan& scanner, LogPlan& plan) {
  const auto& steps = survey.scanners.at(name).robot_from_laser;
  const bool front = name != "RLASER";
  const auto offset =
      parameterOf(survey.parameters, front ? "robot_frontlaser_offset" : "robot_rearlaser_offset");
  Pose2 by_parameters;
  if (offset) by_parameters = front ? Pose2{*offset, 0, 0} : Pose2{-*offset, 0, std::numbers::pi};
  if (steps.empty()) {
    plan.warnings.push_back(name + ": has no poses; the scanner is taken to be " +
                            (offset ? "where PARAM says" : "at the robot's centre") + " (--pose places it)");
    return by_parameters;
  }
  const auto fixed = fixedStep(steps);
  scanner.corrected = !fixed;
  if (!fixed)
    plan.warnings.push_back(
        name +
        ": the laser's poses are not at one place of the robot: another program has corrected "
        "them, and they are not used; the scanner is taken to be " +
        (offset ? "where PARAM says" : "at the robot's centre"));
  const bool at_centre = fixed && std::hypot(fixed->x, fixed->y) < 1e-4 && std::abs(fixed->yaw) < 1e-4;
  return !fixed || (at_centre && offset) ? by_parameters : *fixed;
}

void planScanners(const Survey& survey, const CarmenImportOptions& options, LogPlan& plan) {
  for (const auto& name : sweepsToUse(survey)) {
    const auto& seen = survey.scanners.at(name);
    ScannerPlan scanner;
    scanner.robot_from_laser = placeOf(name, survey, scanner, plan);
    double span = 0;
    if (seen.angles) {
      span = seen.angles->step * static_cast<double>(seen.readings - 1);
      scanner.max_range_m = seen.angles->max_range_m;
    } else {
      scanner.field_of_view = options.field_of_view;
      scanner.step = stepOf(survey.parameters, name != "RLASER", seen.readings);
      span = assumedAngles(scanner, seen.readings).step * static_cast<double>(seen.readings - 1);
      scanner.max_range_m = maxRange(seen.largest, seen.times_largest);
    }
    if (options.max_range_m) scanner.max_range_m = *options.max_range_m;
    if (!(scanner.max_range_m > 0)) scanner.max_range_m = maxRange(seen.largest, seen.times_largest);
    plan.used.push_back(name + ": " + std::to_string(seen.readings) + " beams over " +
                        formatted("%.1f deg, ", span / kDegree) +
                        formatted("less than %.5g m", scanner.max_range_m));
    plan.scanners.emplace(name, scanner);
  }
}

void planOdometry(const Survey& survey, LogPlan& plan) {
  std::size_t most = 0;
  const auto consider = [&](const std::string& name, const std::vector<Pose2>& poses) {
    // One that stands still may be one that was never filled in.
    const std::size_t value =
        (poses.empty() ? 0 : survey.clocks.at(name).ipc.size()) * (poses.size() > 1 ? 1'000'000 : 1);
    if (value <= most) return;
    most = value;
    plan.odometry = name;
  };
  consider("ODOM", survey.odometry);
  for (const auto& [name, scanner] : plan.scanners) consider(name, survey.scanners.at(name).robot);
  if (!plan.odometry.empty())
    plan.used.push_back("odometry: " + plan.odometry +
                        (plan.odometry == "ODOM" ? "" : ", the robot's pose of each sweep"));
}

void planCarmenTruth(const Survey& survey, const CarmenImportOptions& options, const std::string& name,
                     LogPlan& plan) {
  if (survey.true_poses > 0) {
    plan.truth = "TRUEPOS";
    return;
  }
  for (const auto& [sweep, scanner] : plan.scanners)
    if (scanner.corrected && options.corrected_as_truth && plan.truth.empty()) plan.truth = sweep;
  if (options.corrected_as_truth && plan.truth.empty())
    throw ConfigError(name +
                      ": no corrected poses in it: the laser's poses are those of the robot's odometry");
}

}  // namespace

void Survey::take(const Message& message) {
  if (message.name.empty()) return;
  if (const auto* parameter = std::get_if<Parameter>(&message.content)) {
    parameters.insert_or_assign(parameter->name, parameter->value);
    return;
  }
  if (std::holds_alternative<std::monostate>(message.content)) {
    ++others[message.name];
    return;
  }
  auto& clock = clocks[message.name];
  clock.jumps_back += !clock.ipc.empty() && message.stamps.ipc < clock.ipc.back() - 1;
  clock.ipc.push_back(message.stamps.ipc);
  if (message.stamps.logger) clock.ipc_minus_logger.push_back(message.stamps.ipc - *message.stamps.logger);
  if (const auto* sweep = std::get_if<Sweep>(&message.content)) takeSweep(message, *sweep);
  if (const auto* wheels = std::get_if<Odometry>(&message.content)) noteMovement(odometry, wheels->pose);
  true_poses += std::holds_alternative<TruePose>(message.content);
}

void Survey::takeSweep(const Message& message, const Sweep& sweep) {
  const bool first = !scanners.contains(message.name);
  auto& scanner = scanners[message.name];
  if (first) {
    scanner.readings = sweep.ranges.size();
    scanner.angles = sweep.angles;
  }
  for (const float range : sweep.ranges) {
    if (!std::isfinite(range) || range < scanner.largest) continue;
    scanner.times_largest = range > scanner.largest ? 1 : scanner.times_largest + 1;
    scanner.largest = range;
  }
  if (!sweep.laser) return;
  scanner.robot_from_laser.push_back(sweep.robot->inverse() * *sweep.laser);
  noteMovement(scanner.robot, *sweep.robot);
}

Sweep::Angles assumedAngles(const ScannerPlan& scanner, std::size_t readings) {
  const double intervals = static_cast<double>(readings) - 1;
  if (scanner.field_of_view)
    return {-0.5 * *scanner.field_of_view, *scanner.field_of_view,
            intervals > 0 ? *scanner.field_of_view / intervals : 0};
  const double steps = readings % 2 == 0 ? intervals + 1 : intervals;
  const double step = scanner.step.value_or(steps > 0 ? std::numbers::pi / steps : 0);
  return {-0.5 * steps * step, steps * step, step};
}

double maxRange(float largest, int times_largest) {
  // What the scanner sends instead of a range: the nine largest of its 13, 14 or 15 bits, in mm or cm (SICK,
  // Telegrams for Operating and Configuring the LMS 2xx).
  struct Codes {
    double low, high;
  };
  constexpr Codes kSick[] = {{8.183, 8.191}, {16.375, 16.383}, {32.759, 32.767}, {81.83, 81.91}};
  constexpr int kRepeated = 5;
  for (const auto& codes : kSick)
    if (largest > codes.low - 1e-4 && largest < codes.high + 1e-4) return codes.low;
  return times_largest >= kRepeated ? static_cast<double>(largest)
                                    : std::nextafter(static_cast<double>(largest), 1e9);
}

LogPlan planLog(const Survey& survey, const CarmenImportOptions& options, const std::string& name) {
  LogPlan plan;
  if (survey.scanners.empty() && survey.odometry.empty()) {
    std::vector<std::string> names;
    for (const auto& [other, count] : survey.others)
      if (names.size() < 5) names.push_back(other.substr(0, 20));
    throw InputError(name +
                     ": no message of a CARMEN log that can be used (FLASER, RLASER, ROBOTLASER1, "
                     "RAWLASER1, ODOM)" +
                     (names.empty() ? "" : "; there is: " + join(names)));
  }
  planTimes(survey, options, name, plan);
  planScanners(survey, options, plan);
  planOdometry(survey, plan);
  planCarmenTruth(survey, options, name, plan);
  if (plan.scanners.empty()) plan.warnings.push_back("no sweeps in it, only odometry");
  if (plan.odometry.empty()) plan.warnings.push_back("no odometry in it, only sweeps");
  for (const auto& [label, pose] : options.sensor_poses)
    if (!plan.scanners.contains(label))
      throw ConfigError("--pose " + label + ": no such scanner is imported; there is: " + [&] {
        std::vector<std::string> names;
        for (const auto& [sweep, scanner] : plan.scanners) names.push_back(sweep);
        return join(names);
      }());
  return plan;
}

}  // namespace roomgraph::carmen
