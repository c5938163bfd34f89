// SPDX-License-Identifier: BSD-3-Clause
// Choice of sensors, conversion and plausibility checks of records in the order in which they come.
#include "roomgraph/datasets/record_converter.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <mutex>

#include "continued_time.h"
#include "frame_conversion.h"
#include "image_folder.h"
#include "odometry_sum.h"
#include "plausibility.h"
#include "record_correction.h"
#include "record_source.h"
#include "repetition.h"
#include "roomgraph/observations/detection_comment.h"
#include "sensor_choice.h"
#include "stamp_queue.h"

namespace roomgraph {

using mrpt::obs::CActionCollection;
using mrpt::obs::CObservation;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationOdometry;
using mrpt::obs::CSensoryFrame;

// Boxes say nothing of clocks: they have the stamps of their images.
std::string clockOf(const Record& record) {
  if (const auto* frame = std::get_if<Frame>(&record)) return "camera " + frame->sensor_label;
  if (const auto* scan = std::get_if<Scan>(&record)) return "lidar " + scan->sensor_label;
  return std::holds_alternative<OdometryReading>(record) ? "wheels" : "";
}

// `wheels`: whether there are any.
std::string sensorHangs(bool wheels) {
  return std::string(": the same as those before it") + (wheels ? " while the wheels turned" : "") + ", the sensor hangs";
}

void addToTime(Record& record, double seconds) {
  if (auto* detections = std::get_if<std::shared_ptr<CObservationDetections>>(&record))
    (*detections)->timestamp = mrpt::Clock::fromDouble(timeOf(record) + seconds);
  else if (auto* frame = std::get_if<Frame>(&record))
    frame->t += seconds;
  else if (auto* scan = std::get_if<Scan>(&record))
    scan->t += seconds;
  else
    std::get<OdometryReading>(record).t += seconds;
}

struct RecordConverter::Impl {
  Impl(const ReadOptions& read_options, const std::filesystem::path& recording)
      : options(read_options),
        choices(options),
        correction(options.corrections),
        image_folder(recording.empty() ? std::string() : imageFolderOf(recording)) {}

  std::optional<Record> nextAsRecorded();
  std::optional<Record> nextInTime();
  void end();
  void take(const mrpt::serialization::CSerializable::Ptr& object);
  void takeActions(const CActionCollection& actions);
  void takeObservation(const CObservation::Ptr& written);
  void giveTimeToOdometry(double t);
  bool isOfAnotherSensor(const CObservation& observation);
  std::optional<Record> convert(const CObservation::Ptr& observation);
  std::optional<Record> convertFrame(CObservation3DRangeScan& observation);
  std::string groupedReason(const std::string& reason);

  ReadOptions options;
  SensorChoices choices;
  RecordCorrection correction;
  std::mutex correcting;
  std::string image_folder;
  ReadStatistics statistics;
  OdometrySum odometry;
  bool odometry_waits = false;  ///< for the time of the next observation
  // Observations are converted when they are asked for: a sensory frame may hold many images.
  StampQueue<std::variant<CObservation::Ptr, OdometryReading>> waiting;
  ContinuedTime<Record> time;
  bool ended = false;
  std::int64_t frame_count = 0;
  OneCamera camera;
  HangingSensor hanging_camera, hanging_lidar;
  std::optional<Pose2> wheels;  ///< the latest reading
  std::string missing_image;  ///< reason of the first frame whose image is missing
};

void RecordConverter::Impl::takeActions(const CActionCollection& actions) {
  if (const auto problem = odometry.add(actions); !problem.empty()) {
    ++statistics.skipped["CActionCollection: " + problem];
    return;
  }
  odometry_waits = !odometry.time();
  if (!odometry_waits)
    waiting.push("CActionCollection", *odometry.time(), OdometryReading{*odometry.time(), odometry.pose()});
}

void RecordConverter::Impl::giveTimeToOdometry(double t) {
  if (!odometry_waits) return;
  odometry_waits = false;
  waiting.push("CActionCollection", t, OdometryReading{t, odometry.pose()});
}

void RecordConverter::Impl::takeObservation(const CObservation::Ptr& written) {
  if (!written) return;
  const auto meant = unpacked(written);
  if (!meant) {
    ++statistics.skipped[meant.reason()];
    return;
  }
  const CObservation::Ptr& observation = *meant;
  const std::string name = shortClassName(observation->GetRuntimeClass()->className);
  const auto t = toSeconds(observation->timestamp);
  if (!t) {
    ++statistics.skipped[name + ": invalid time stamp"];
  } else if (const auto problem = problemOf(*observation); !problem.empty()) {
    ++statistics.skipped[name + ": " + problem];
  } else {
    giveTimeToOdometry(*t);
    waiting.push(name + " " + observation->sensorLabel, *t, observation);
  }
}

void RecordConverter::Impl::take(const mrpt::serialization::CSerializable::Ptr& object) {
  if (const auto actions = std::dynamic_pointer_cast<CActionCollection>(object)) {
    takeActions(*actions);
  } else if (const auto frame = std::dynamic_pointer_cast<CSensoryFrame>(object)) {
    for (const auto& observation : *frame) takeObservation(observation);
  } else if (const auto observation = std::dynamic_pointer_cast<CObservation>(object)) {
    takeObservation(observation);
  } else {
    const std::string name = object ? shortClassName(object->GetRuntimeClass()->className) : "empty object";
    ++statistics.skipped[name + ": not used"];
  }
}

// The missing images of a folder are one problem, named by the first of them.
std::string RecordConverter::Impl::groupedReason(const std::string& reason) {
  if (!reason.starts_with("image missing")) return reason;
  if (missing_image.empty()) missing_image = reason;
  return missing_image;
}

std::optional<Record> RecordConverter::Impl::convertFrame(CObservation3DRangeScan& observation) {
  auto frame = toFrame(observation, image_folder);
  if (!frame) {
    ++statistics.skipped[groupedReason(frame.reason())];
    return std::nullopt;
  }
  if (!camera.takes(*frame)) {
    ++statistics.skipped["CObservation3DRangeScan " + labelText(observation.sensorLabel) +
                         ": not the camera of the first image: several cameras have this label"];
    return std::nullopt;
  }
  if (hanging_camera.hangs(frame->t, contentOf(observation), wheels)) {
    ++statistics.skipped[std::string("CObservation3DRangeScan") + sensorHangs(wheels.has_value())];
    return std::nullopt;
  }
  frame->id = FrameId{frame_count++};
  return std::move(*frame);
}

// Of the kinds that are wanted, one sensor each.
bool RecordConverter::Impl::isOfAnotherSensor(const CObservation& observation) {
  const std::string& label = observation.sensorLabel;
  if (options.frames && dynamic_cast<const CObservation3DRangeScan*>(&observation))
    return !choices.rgbd.takes(label);
  if (options.scans && dynamic_cast<const CObservation2DRangeScan*>(&observation))
    return !choices.lidar.takes(label);
  if (options.odometry && dynamic_cast<const CObservationOdometry*>(&observation))
    return !choices.odometry.takes(label);
  return false;
}

std::optional<Record> RecordConverter::Impl::convert(const CObservation::Ptr& observation) {
  const std::string name = shortClassName(observation->GetRuntimeClass()->className);
  if (isOfAnotherSensor(*observation)) {
    ++statistics.skipped[name + " " + labelText(observation->sensorLabel) + ": another sensor was chosen"];
    return std::nullopt;
  }
  placeSensor(*observation, options.sensor_poses);
  std::optional<Record> record;
  bool wanted = true;
  if (const auto images = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation)) {
    wanted = options.frames;
    if (wanted && !(record = convertFrame(*images))) return std::nullopt;
  } else if (const auto scan = std::dynamic_pointer_cast<CObservation2DRangeScan>(observation)) {
    wanted = options.scans;
    if (wanted && hasReturn(*scan) && hanging_lidar.hangs(mrpt::Clock::toDouble(scan->timestamp), contentOf(*scan), wheels)) {
      ++statistics.skipped[name + sensorHangs(wheels.has_value())];
      return std::nullopt;
    }
    if (wanted) record = toScan(*scan);
  } else if (const auto reading = std::dynamic_pointer_cast<CObservationOdometry>(observation)) {
    wanted = options.odometry;
    wheels = {reading->odometry.x(), reading->odometry.y(), reading->odometry.phi()};
    if (wanted) record = OdometryReading{mrpt::Clock::toDouble(reading->timestamp), *wheels};
  } else if (const auto detections = std::dynamic_pointer_cast<CObservationDetections>(observation)) {
    record = detections;
  }
  if (record)
    ++statistics.used[name];
  else
    ++statistics.skipped[name + (wanted ? ": not used" : ": not asked for")];
  return record;
}

void RecordConverter::Impl::end() {
  if (odometry_waits) ++statistics.skipped["CActionCollection: no time stamp, and no observation after it"];
  odometry_waits = false;
  ended = true;
}

std::optional<Record> RecordConverter::Impl::nextAsRecorded() {
  while (const auto entry = waiting.pop(ended)) {
    if (entry->stamp_is_wrong) {
      ++statistics.skipped[entry->sensor.substr(0, entry->sensor.find(' ')) + ": " + kStampIsWrong];
    } else if (const auto* reading = std::get_if<OdometryReading>(&entry->record)) {
      wheels = reading->odom_from_robot;
      if (options.odometry && choices.odometry.takes("")) {
        ++statistics.used["CActionCollection"];
        return *reading;
      }
      ++statistics.skipped[std::string("CActionCollection: ") +
                           (options.odometry ? "another sensor was chosen" : "not asked for")];
    } else if (auto record = convert(std::get<CObservation::Ptr>(entry->record))) {
      return record;
    }
  }
  return std::nullopt;
}

std::optional<Record> RecordConverter::Impl::nextInTime() {
  if (!options.continue_time) return nextAsRecorded();
  bool complete = false;
  while (true) {
    if (auto item = time.pop(complete)) {
      if (item->added_s != 0) addToTime(item->record, item->added_s);
      return std::move(item->record);
    }
    auto record = nextAsRecorded();
    if (!record && (!ended || complete)) return std::nullopt;
    complete = !record;
    if (!record) continue;
    const double t = timeOf(*record);
    time.push(clockOf(*record), t, std::move(*record));
  }
}

RecordConverter::RecordConverter(const ReadOptions& options, const std::filesystem::path& recording)
    : impl_(std::make_unique<Impl>(options, recording)) {}
RecordConverter::~RecordConverter() = default;
RecordConverter::RecordConverter(RecordConverter&&) noexcept = default;
RecordConverter& RecordConverter::operator=(RecordConverter&&) noexcept = default;

void RecordConverter::take(const mrpt::serialization::CSerializable::Ptr& object) {
  impl_->take(object);
}
void RecordConverter::skip(const std::string& reason) {
  ++impl_->statistics.skipped[reason];
}
void RecordConverter::end(const std::string& warning) {
  impl_->end();
  impl_->statistics.warning = warning;
}

std::optional<Record> RecordConverter::next() {
  auto record = impl_->nextInTime();
  const std::lock_guard lock(impl_->correcting);
  if (record) impl_->correction.apply(*record);
  return record;
}

StampJumpsBySensor RecordConverter::stampJumps() const {
  const std::lock_guard lock(impl_->correcting);
  return impl_->correction.jumps();
}

const ReadStatistics& RecordConverter::statistics() const {
  impl_->statistics.sensor_warnings = impl_->choices.warnings();
  impl_->statistics.corrected = impl_->correction.counts();
  impl_->statistics.placed = impl_->options.sensor_poses;
  impl_->statistics.clocks_set_back = impl_->time.found();
  return impl_->statistics;
}

double timeOf(const Record& record) {
  return std::visit(
      [](const auto& value) {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, std::shared_ptr<CObservationDetections>>)
          return mrpt::Clock::toDouble(value->timestamp);
        else
          return value.t;
      },
      record);
}

}  // namespace roomgraph
