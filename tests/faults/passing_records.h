// SPDX-License-Identifier: BSD-3-Clause
// Records for faults, as they come out of a recording that begins at kStart_s.
#pragma once

#include "../datasets/rawlog_maker.h"
#include "fault.h"
#include "roomgraph/observations/detection_comment.h"

namespace roomgraph::test {

constexpr double kStart_s = 1000;

inline PassingRecord passing(const mrpt::obs::CObservation::Ptr& observation) {
  return {mrpt::Clock::toDouble(observation->timestamp) - kStart_s, sensorOf(*observation), observation,
          bytesOf(observation)};
}

inline PassingRecord scanAt(double t, float range = 2) {
  return passing(makeScan(kStart_s + t, range));
}
inline PassingRecord odometryAt(double t, double x, double y = 0, double yaw = 0) {
  return passing(makeOdometry(kStart_s + t, x, y, yaw));
}
inline PassingRecord imagesAt(double t) {
  return passing(makeImages(kStart_s + t));
}

/// Recorded detections of one box.
inline PassingRecord boxesAt(double t) {
  CObservationDetections detections;
  detections.timestamp = mrpt::Clock::fromDouble(kStart_s + t);
  detections.sensorLabel = "BOXES";
  detections.items.push_back({"chair", 0.5, 1, 2, 3, 4, 7});
  return passing(std::make_shared<mrpt::obs::CObservationComment>(toComment(detections)));
}

/// What comes out of the fault for these records.
inline PassingRecords through(Fault& fault, const PassingRecords& records) {
  PassingRecords out;
  for (const auto& record : records)
    for (auto& left : fault.pass(record.clone())) out.push_back(std::move(left));
  for (auto& left : fault.finish()) out.push_back(std::move(left));
  return out;
}

/// Stamps, s after the start, rounded to 1 ms.
inline std::vector<double> stampsOf(const PassingRecords& records) {
  std::vector<double> stamps;
  for (const auto& record : records)
    stamps.push_back(std::round(1e3 * (mrpt::Clock::toDouble(record.observation->timestamp) - kStart_s)) /
                     1e3);
  return stamps;
}

template <class Observation>
const Observation& as(const PassingRecord& record) {
  return dynamic_cast<const Observation&>(*record.observation);
}

inline const mrpt::obs::CObservation2DRangeScan& scanOf(const PassingRecord& record) {
  return as<mrpt::obs::CObservation2DRangeScan>(record);
}
inline const mrpt::obs::CObservation3DRangeScan& imagesOf(const PassingRecord& record) {
  return as<mrpt::obs::CObservation3DRangeScan>(record);
}
inline const mrpt::poses::CPose2D& odometryOf(const PassingRecord& record) {
  return as<mrpt::obs::CObservationOdometry>(record).odometry;
}

/// Whether it may be copied byte by byte, and the bytes are those of its observation.
inline bool keepsBytes(const PassingRecord& record) {
  return !record.bytes.empty() && record.bytes == bytesOf(record.observation);
}

using Counts = std::map<std::string, int>;

}  // namespace roomgraph::test
