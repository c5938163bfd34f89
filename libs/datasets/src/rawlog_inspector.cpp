// SPDX-License-Identifier: BSD-3-Clause
// One pass over a rawlog that gathers the statistics of every sensor into a RawlogReport.
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>

#include "clock_offset.h"
#include "continued_time.h"
#include "image_folder.h"
#include "odometry_statistics.h"
#include "odometry_sum.h"
#include "plausibility.h"
#include "record_source.h"
#include "roomgraph/datasets/rawlog_report.h"
#include "roomgraph/observations/CObservationDetections.h"
#include "roomgraph/observations/detection_comment.h"
#include "sensor_choice.h"
#include "sensor_statistics.h"
#include "stamp_queue.h"

namespace roomgraph {
namespace {

using mrpt::obs::CActionCollection;
using mrpt::obs::CObservation;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationOdometry;

constexpr double kPoseTolerance = 1e-6;  // m, rad

bool showsTheClock(const CObservation& observation) {
  return dynamic_cast<const CObservation2DRangeScan*>(&observation) || dynamic_cast<const CObservation3DRangeScan*>(&observation) ||
         dynamic_cast<const CObservationOdometry*>(&observation);
}

struct Sensor {
  SensorReport report;
  TimeStatistics times;
  std::vector<FilePlace> places;
  std::optional<ImageStatistics> images;
  std::optional<ScanStatistics> scans;
  std::optional<OdometryStatistics> odometry;
};

class Inspector {
 public:
  Inspector(const std::filesystem::path& file, const SensorPoses& poses)
      : image_folder_(imageFolderOf(file)), poses_(poses) {}

  void add(const mrpt::serialization::CSerializable::Ptr& object) {
    take(object);
    useWaiting(false);
  }
  /// No more records.
  void finish() {
    useWaiting(true);
  }

  void report(RawlogReport& out) const {
    for (const auto& [reason, count] : skipped_) out.skipped[reason] += count;
    out.format = paired_ == 0 ? "observations" : single_ == 0 ? "actions and sensory frames" : "mixed";
    out.records = paired_ + single_;
    out.clocks_set_back = time_.found();
    out.largest_step_back_s = largest_step_back_;
    out.first_time = std::numeric_limits<double>::infinity();
    out.last_time = -out.first_time;
    for (const auto& entry : sensors_) {
      SensorReport line = entry->report;
      entry->times.report(line);
      if (entry->images) line.images = entry->images->report();
      if (entry->scans) line.scans = entry->scans->report(odometry_);
      if (entry->odometry) line.odometry = odometryOf(*entry->odometry);
      line.clock_offset = offsetOf(*entry);
      if (line.count > line.invalid_times) {
        out.first_time = std::min(out.first_time, line.first_time);
        out.last_time = std::max(out.last_time, line.last_time);
      }
      out.sensors.push_back(std::move(line));
    }
    if (out.first_time > out.last_time) out.first_time = out.last_time = 0;
  }

  /// By its own clock, of that sensor in use of which least was looked at; 0 without one.
  double leastSeconds() const {
    std::optional<double> out;
    for (const auto& entry : sensors_)
      if (entry->report.used && !entry->places.empty()) {
        const double seconds = entry->places.back().t - entry->places.front().t;
        out = std::min(out.value_or(seconds), seconds);
      }
    return out.value_or(0);
  }

 private:
  void take(const mrpt::serialization::CSerializable::Ptr& object) {
    if (const auto actions = std::dynamic_pointer_cast<CActionCollection>(object)) {
      ++paired_;
      addActions(*actions);
    } else if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) {
      ++paired_;
      for (const auto& observation : *frame) take(observation);
    } else if (const auto observation = std::dynamic_pointer_cast<CObservation>(object)) {
      ++single_;
      take(observation);
    } else if (object) {
      sensor("", shortClassName(object->GetRuntimeClass()->className)).times.add(std::nullopt);
    }
  }

  // Implausible ones are left out here just as when they are replayed.
  void take(const CObservation::Ptr& written) {
    if (!written) return;
    const auto meant = unpacked(written);
    if (!meant) {
      ++skipped_[meant.reason()];
      return;
    }
    const CObservation::Ptr& observation = *meant;
    const std::string name = shortClassName(observation->GetRuntimeClass()->className);
    if (const auto problem = problemOf(*observation); !problem.empty())
      ++skipped_[name + ": " + problem];
    else if (const auto t = toSeconds(observation->timestamp))
      waiting_.push(name + " " + observation->sensorLabel, *t, observation);
    else
      addObservation(observation);
  }

  void useWaiting(bool complete) {
    while (const auto item = waiting_.pop(complete)) {
      const std::string name = shortClassName(item->record->GetRuntimeClass()->className);
      if (item->stamp_is_wrong)
        ++skipped_[name + ": " + kStampIsWrong];
      else
        time_.push(showsTheClock(*item->record) ? item->sensor : "", item->t, [this, t = item->t, observation = item->record](double added_s) {
          if (added_s != 0) observation->timestamp = mrpt::Clock::fromDouble(t + added_s);
          addObservation(observation);
        });
    }
    while (const auto item = time_.pop(complete)) item->record(item->added_s);
  }

  Sensor& sensor(const std::string& label, const std::string& class_name) {
    for (const auto& entry : sensors_)
      if (entry->report.label == label && entry->report.class_name == class_name) return *entry;
    sensors_.push_back(std::make_unique<Sensor>());
    sensors_.back()->report.label = label;
    sensors_.back()->report.class_name = class_name;
    return *sensors_.back();
  }

  // With the standstill in which the first lidar sees most change.
  OdometrySummary odometryOf(const OdometryStatistics& statistics) const {
    OdometrySummary out = statistics.report();
    const auto lidar = std::find_if(sensors_.begin(), sensors_.end(), [](const auto& s) { return s->scans; });
    if (lidar == sensors_.end()) return out;
    for (OdometryStandstill standstill : statistics.standstills()) {
      standstill.scan_change_m =
          (*lidar)->scans->change(standstill.from, standstill.from + standstill.seconds);
      if (!out.standstill || standstill.scan_change_m > out.standstill->scan_change_m)
        out.standstill = standstill;
    }
    return out;
  }

  // Against the first sensor that is used.
  std::optional<ClockOffset> offsetOf(const Sensor& entry) const {
    for (const auto& reference : sensors_) {
      if (!reference->report.used || reference->places.empty()) continue;
      if (reference.get() == &entry || !entry.report.used) return std::nullopt;
      auto offset = clockOffset(reference->places, entry.places);
      if (offset) offset->reference = reference->report.label;
      return offset;
    }
    return std::nullopt;
  }

  void addTime(Sensor& entry, std::optional<double> t) {
    ++index_;
    entry.times.add(t);
    if (!t) return;
    entry.places.push_back({index_, *t});
    largest_step_back_ = std::max(largest_step_back_, latest_ - *t);
    latest_ = std::max(latest_, *t);
  }

  void addOdometry(Sensor& entry, std::optional<double> t, const Pose2& pose) {
    entry.report.used = true;
    if (!entry.odometry) entry.odometry.emplace();
    entry.odometry->add(t, pose);
    if (t && (odometry_.empty() || *t > odometry_.lastTime())) odometry_.add(*t, toPose3(pose));
  }

  void addActions(const CActionCollection& actions) {
    if (const auto problem = sum_.add(actions); !problem.empty()) {
      ++skipped_["CActionCollection: " + problem];
      return;
    }
    const auto add = [this, pose = sum_.pose()](std::optional<double> t) {
      Sensor& entry = sensor("", "CActionCollection");
      addTime(entry, t);
      addOdometry(entry, t, pose);
    };
    if (const auto t = sum_.time())
      time_.push("CActionCollection", *t, [add, t](double added_s) { add(*t + added_s); });
    else
      add(std::nullopt);
  }

  void addPose(Sensor& entry, const CObservation& observation) {
    mrpt::poses::CPose3D sensor_pose;
    observation.getSensorPose(sensor_pose);
    const Pose3 pose = toPose3(sensor_pose);
    if (!entry.report.robot_from_sensor) entry.report.robot_from_sensor = pose;
    entry.report.pose_changes =
        entry.report.pose_changes || !pose.isApprox(*entry.report.robot_from_sensor, kPoseTolerance);
  }

  void addObservation(const CObservation::Ptr& observation) {
    Sensor& entry =
        sensor(observation->sensorLabel, shortClassName(observation->GetRuntimeClass()->className));
    const auto t = toSeconds(observation->timestamp);
    addTime(entry, t);
    if (const auto wheels = std::dynamic_pointer_cast<CObservationOdometry>(observation)) {
      addOdometry(entry, t, {wheels->odometry.x(), wheels->odometry.y(), wheels->odometry.phi()});
      return;
    }
    placeSensor(*observation, poses_);
    addPose(entry, *observation);
    if (const auto scan = std::dynamic_pointer_cast<CObservation2DRangeScan>(observation)) {
      entry.report.used = true;
      if (!entry.scans) entry.scans.emplace();
      entry.scans->add(*scan);
      for (const auto& other : sensors_)
        if (other->images && t) other->images->addScan(toScan(*scan));
    } else if (const auto images = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation)) {
      entry.report.used = true;
      if (!entry.images) entry.images.emplace();
      try {
        entry.images->add(*images, image_folder_);
      } catch (const std::exception& error) {
        ++skipped_["CObservation3DRangeScan: image unreadable: " + firstLine(error)];
      }
    } else {
      entry.report.used = std::dynamic_pointer_cast<CObservationDetections>(observation) != nullptr;
    }
  }

  std::string image_folder_;
  SensorPoses poses_;
  std::vector<std::unique_ptr<Sensor>> sensors_;
  StampQueue<CObservation::Ptr> waiting_;
  ContinuedTime<std::function<void(double added_s)>> time_;
  std::map<std::string, int> skipped_;
  OdometrySum sum_;
  Trajectory odometry_;
  int paired_ = 0, single_ = 0, index_ = 0;
  double latest_ = -std::numeric_limits<double>::infinity(), largest_step_back_ = 0;
};

}  // namespace

const char* toString(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return "error";
    case Severity::kWarning:
      return "warning";
    default:
      return "note";
  }
}

RawlogReport inspectRawlog(const std::filesystem::path& file, const std::function<void(double)>& progress,
                           const SensorPoses& poses, double until_s) {
  RecordSource source(file);
  checkLabels(file, {.sensor_poses = poses});
  Inspector inspector(file, poses);
  RawlogReport report;
  report.file = file;
  report.file_bytes = std::filesystem::file_size(file);
  while (const auto item = source.next()) {
    if (item->object)
      inspector.add(item->object);
    else
      ++report.skipped[item->reason];
    const double of_span = until_s > 0 ? inspector.leastSeconds() / until_s : 0;
    if (progress) progress(std::min(1.0, std::max(of_span, source.progress())));
    if (of_span > 1) break;
  }
  inspector.finish();
  inspector.report(report);
  report.truncation = source.truncation();
  report.findings = findProblems(report);
  return report;
}

}  // namespace roomgraph
