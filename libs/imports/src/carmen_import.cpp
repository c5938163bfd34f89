// SPDX-License-Identifier: BSD-3-Clause
// The two readings of a CARMEN log, and the records that come of its messages.
#include "roomgraph/imports/carmen_import.h"

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "carmen_survey.h"
#include "gz_lines.h"
#include "ordered_records.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/import_output.h"

namespace roomgraph {
namespace carmen {
namespace {

constexpr double kSurveyPart = 0.4;             // of the time that both readings take
constexpr double kWindow_s = 5;                 // by which messages of a log may be out of order
constexpr double kEndOfTime_s = 7'258'118'400;  // 2200-01-01
constexpr std::size_t kPlacesTold = 3;

std::string poseLine(double t, const Pose2& pose) {
  char text[200];
  std::snprintf(text, sizeof text, "%.6f %.9g %.9g 0 0 0 %.9g %.9g\n", t, pose.x, pose.y,
                std::sin(0.5 * pose.yaw), std::cos(0.5 * pose.yaw));
  return text;
}

/// Second reading. Owns what changes meanwhile: records on their way, ground truth, tallies.
class Conversion {
 public:
  Conversion(const LogPlan& plan, const CarmenImportOptions& options, OrderedRecords& records)
      : plan_(plan), options_(options), records_(records) {}

  void take(const Message& message) {
    if (std::holds_alternative<std::monostate>(message.content) ||
        std::holds_alternative<Parameter>(message.content))
      return;
    const auto t = timeOf(message);
    if (!t) return skip(message.name + ": time is not between 1970 and 2200");
    if (const auto* odometry = std::get_if<Odometry>(&message.content)) takeOdometry(*t, *odometry);
    if (const auto* sweep = std::get_if<Sweep>(&message.content)) takeSweep(*t, message.name, *sweep);
    const auto* truth = std::get_if<TruePose>(&message.content);
    if (truth && plan_.truth == message.name) addTruth(*t, truth->pose);
  }
  void skip(const std::string& reason) { ++skipped_[reason]; }

  const std::map<std::string, int>& skipped() const { return skipped_; }
  const std::string& truth() const { return truth_; }

 private:
  std::optional<double> timeOf(const Message& message) const {
    if (plan_.by_logger && !message.stamps.logger) return std::nullopt;
    const double t = plan_.by_logger ? *message.stamps.logger : message.stamps.ipc;
    return t >= 0 && t < kEndOfTime_s ? std::optional(t) : std::nullopt;
  }
  // In the order of time, as evaluation reads it.
  void addTruth(double t, const Pose2& pose) {
    if (t <= last_truth_) return;
    last_truth_ = t;
    truth_ += poseLine(t, pose);
  }
  void takeOdometry(double t, const Odometry& message) {
    if (plan_.odometry != "ODOM") return;
    auto odometry = makeOdometry(t, message.pose);
    odometry->hasVelocities = true;
    odometry->velocityLocal = {message.forward_m_s, 0, message.turn_rad_s};
    records_.push(odometry);
  }
  void takeSweep(double t, const std::string& name, const Sweep& sweep) {
    const auto found = plan_.scanners.find(name);
    if (found == plan_.scanners.end()) return skip(name + ": the same sweeps are used in another form");
    const ScannerPlan& scanner = found->second;
    if (plan_.odometry == name) records_.push(makeOdometry(t, *sweep.robot));
    if (plan_.truth == name) addTruth(t, *sweep.laser * scanner.robot_from_laser.inverse());
    const auto angles = sweep.angles ? *sweep.angles : assumedAngles(scanner, sweep.ranges.size());
    const double span = angles.step * static_cast<double>(sweep.ranges.size() - 1);
    if (!(angles.step > 0) || span > 2 * std::numbers::pi + angles.step)
      return skip(name + ": impossible angles");
    auto scan = makeScan(sweep, span, scanner.max_range_m);
    scan->timestamp = mrpt::Clock::fromDouble(t);
    scan->sensorLabel = name;
    const auto given = options_.sensor_poses.find(name);
    const Pose2 middle{0, 0, angles.start + 0.5 * span};
    scan->sensorPose = toMrpt(
        given != options_.sensor_poses.end() ? given->second : toPose3(scanner.robot_from_laser * middle));
    records_.push(scan);
  }
  static mrpt::obs::CObservationOdometry::Ptr makeOdometry(double t, const Pose2& pose) {
    auto odometry = mrpt::obs::CObservationOdometry::Create();
    odometry->timestamp = mrpt::Clock::fromDouble(t);
    odometry->sensorLabel = "ODOMETRY";
    odometry->odometry = {pose.x, pose.y, pose.yaw};
    return odometry;
  }
  static mrpt::obs::CObservation2DRangeScan::Ptr makeScan(const Sweep& sweep, double span,
                                                          double max_range_m) {
    auto scan = mrpt::obs::CObservation2DRangeScan::Create();
    scan->aperture = static_cast<float>(std::min(span, 2 * std::numbers::pi));
    scan->rightToLeft = true;
    scan->maxRange = static_cast<float>(max_range_m);
    scan->resizeScan(sweep.ranges.size());
    scan->setScanHasIntensity(!sweep.remissions.empty());
    for (std::size_t i = 0; i < sweep.ranges.size(); ++i) {
      const float range = sweep.ranges[i];
      const bool finite = std::isfinite(range);
      scan->setScanRange(i, finite ? range : 0);
      scan->setScanRangeValidity(i, finite && range > 0 && static_cast<double>(range) < max_range_m);
      if (sweep.remissions.empty()) continue;
      const float remission = sweep.remissions[i];
      scan->setScanIntensity(i, std::abs(remission) < 2e9f ? static_cast<int>(std::lround(remission)) : 0);
    }
    return scan;
  }

  const LogPlan& plan_;
  const CarmenImportOptions& options_;
  OrderedRecords& records_;
  std::map<std::string, int> skipped_;
  std::string truth_;
  double last_truth_ = -1;
};

/// Calls `take` for each message that can be understood; `broken` with the reason and place for each other
/// line. Returns why reading ended before the end of the file, or nothing.
std::string readLog(const std::filesystem::path& log, const std::function<void(const Message&)>& take,
                    const std::function<void(const std::string& reason, std::size_t line)>& broken,
                    const std::function<void(double)>& progress) {
  GzLines lines(log);
  constexpr std::size_t kEvery = 200;
  for (std::string line; lines.next(line);) {
    const auto message = parseLine(line);
    if (message)
      take(*message);
    else
      broken(line.substr(0, std::min<std::size_t>(line.find_first_of(" \t"), 20)) + ": " + message.reason(),
             lines.number());
    if (progress && lines.number() % kEvery == 0) progress(lines.share());
  }
  if (lines.problem().empty()) return "";
  return "after line " + std::to_string(lines.number()) + " " + lines.problem() +
         "; what came before is used";
}

LogPlan survey(const std::filesystem::path& log, const CarmenImportOptions& options,
               const std::function<void(double)>& progress) {
  Survey survey;
  std::vector<std::string> places;
  std::size_t broken = 0;
  const auto problem = readLog(
      log, [&](const Message& message) { survey.take(message); },
      [&](const std::string& reason, std::size_t line) {
        if (++broken <= kPlacesTold) places.push_back("line " + std::to_string(line) + ": " + reason);
      },
      progress);
  if (survey.scanners.empty() && survey.odometry.empty() && !places.empty())
    throw InputError(log.string() + ": nothing in it can be used; " + places.front());
  auto plan = planLog(survey, options, log.string());
  for (const auto& place : places) plan.warnings.push_back(place + "; left out");
  if (broken > kPlacesTold)
    plan.warnings.push_back(std::to_string(broken - kPlacesTold) + " more lines left out");
  if (!problem.empty()) plan.warnings.push_back(problem);
  return plan;
}

}  // namespace
}  // namespace carmen

CarmenImportResult importCarmen(const std::filesystem::path& log, const std::filesystem::path& rawlog,
                                const CarmenImportOptions& options,
                                const std::function<void(double)>& progress) {
  const ImportPlaces places = placesOf(rawlog);
  const ImportInputs inputs{log, {log}};
  checkPlaces(places, inputs, false);
  const auto part = [&](double from, double to) -> std::function<void(double)> {
    if (!progress) return nullptr;
    return [=, &progress](double share) { progress(from + (to - from) * share); };
  };
  const auto plan = carmen::survey(log, options, part(0, carmen::kSurveyPart));
  CarmenImportResult result;
  result.used = plan.used;
  result.warnings = plan.warnings;
  ImportOutput output(places, false);
  OrderedRecords records(carmen::kWindow_s,
                         [&](const mrpt::obs::CObservation& record) { output.rawlog().write(record); });
  carmen::Conversion conversion(plan, options, records);
  carmen::readLog(
      log, [&](const carmen::Message& message) { conversion.take(message); },
      [&](const std::string& reason, std::size_t) { conversion.skip(reason); }, part(carmen::kSurveyPart, 1));
  records.finish();
  result.written = records.written();
  result.skipped = conversion.skipped();
  if (result.written.empty())
    throw InputError(log.string() + ": no record can be made of it" +
                     (result.skipped.empty() ? "" : "; " + result.skipped.begin()->first));
  if (records.late() > 0)
    result.warnings.push_back(std::to_string(records.late()) +
                              " records are older than others that stand more than 5 s before them");
  if (!conversion.truth().empty()) {
    result.ground_truth = places.ground_truth;
    result.truth = plan.truth == "TRUEPOS" ? "TRUEPOS, the simulator's"
                                           : plan.truth + ", as another program corrected it";
    output.setGroundTruth(conversion.truth(), TruthOf::kRobot);
  }
  for (const auto& removed : output.commit(inputs))
    result.warnings.push_back(removed.string() + " of the former import was removed: this one has none");
  return result;
}

}  // namespace roomgraph
