// SPDX-License-Identifier: BSD-3-Clause
// Checks of stamps, gaps, repeated records and wheel odometry.
#include <algorithm>

#include "findings.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

constexpr double kLongGap_s = 1, kGapIntervals = 10;
constexpr double kMoved_m = 0.3;  // mean change per beam that cannot come from noise or one person walking by

bool isLong(double gap_s, const SensorReport& sensor) {
  return gap_s > kLongGap_s && gap_s > kGapIntervals * sensor.median_interval_s;
}

void checkGaps(const RawlogReport& report, const SensorReport& sensor, Findings& out) {
  constexpr const char* kHint = "tracking will have to bridge it by odometry, or will be lost";
  if (isLong(sensor.largest_gap_s, sensor))
    out.warning(format("gap of %.1f s after t = %.3f s (usual interval %.3f s)", sensor.largest_gap_s,
                       sensor.largest_gap_time, sensor.median_interval_s),
                kHint);
  const double before = sensor.first_time - report.first_time, behind = report.last_time - sensor.last_time;
  if (isLong(before, sensor))
    out.warning(format("no record in the first %.1f s of the recording", before),
                "what comes before is found without it");
  if (isLong(behind, sensor))
    out.warning(format("no record in the last %.1f s of the recording", behind),
                "what comes after is found without it");
}

}  // namespace

void checkTimes(const RawlogReport& report, const SensorReport& sensor, Findings& out) {
  const int valid = sensor.count - sensor.invalid_times;
  if (sensor.invalid_times > 0 && sensor.class_name == "CActionCollection")
    out.note(format("%d of %d actions have no time stamp", sensor.invalid_times, sensor.count),
             "they take the time of the next observation");
  else if (sensor.invalid_times > 0)
    out.warning(format("%d of %d records have no valid time stamp", sensor.invalid_times, sensor.count),
                "such records are left out; set the stamps where they are recorded");
  const bool all_equal = valid > 1 && sensor.first_time == sensor.last_time;
  if (all_equal)
    out.error("all time stamps are equal",
              "the order and speed of movement are lost: export the recording again");
  else if (sensor.repeated_stamps > 0)
    out.warning(format("%d records have the time stamp of the one before", sensor.repeated_stamps),
                "the second of two is left out");
  if (sensor.out_of_order > 0)
    out.warning(format("%d records are older than the one before; first: record %d", sensor.out_of_order,
                       sensor.first_out_of_order),
                "sort the records by time stamp and save again");
  if (valid > 1) checkGaps(report, sensor, out);
}

void checkRepetition(const SensorReport& sensor, Findings& out) {
  constexpr double kLeast_s = 1;
  constexpr int kLeastRecords = 3;
  const char* hint = "did the driver hang? Cut the span out, or record again";
  const auto check = [&](const SameRecords& same, const char* what) {
    if (same.records >= kLeastRecords && same.seconds >= kLeast_s)
      out.warning(format("%d %s in a row are the same, for %.1f s from t = %.3f s", same.records, what,
                         same.seconds, same.from),
                  hint);
  };
  if (sensor.images) check(sensor.images->same, "images");
  if (sensor.scans) check(sensor.scans->same, "scans");
}

void checkOdometry(const RawlogReport& report, const SensorReport& sensor, Findings& out) {
  const OdometrySummary& odometry = *sensor.odometry;
  const bool never = odometry.path_length_m == 0 && odometry.turn_rad == 0;
  if (odometry.jumps > 0)
    out.warning(format("%d jumps, the largest of %.2f m and %.0f deg; first after t = %.3f s", odometry.jumps,
                       odometry.largest_jump_m, odometry.largest_jump_rad * kDegreesPerRadian,
                       odometry.first_jump_time),
                "no robot in a room moves so fast: did the odometry start anew, or lose readings?");
  if (!never && odometry.standstill && odometry.standstill->scan_change_m > kMoved_m)
    out.warning(format("it stands still for %.1f s from t = %.3f s while the scans change",
                       odometry.standstill->seconds, odometry.standstill->from),
                "did the wheels slip, or the driver hang? Compare a run with --set odometry.enabled=false");
  if (sensor.count < 2 || !never) return;
  const bool moving = std::any_of(
      report.sensors.begin(), report.sensors.end(),
      [](const SensorReport& other) { return other.scans && other.scans->largest_change_m > kMoved_m; });
  if (moving)
    out.error("odometry never changes while the scans do", "run with --set odometry.enabled=false");
  else
    out.note("odometry never changes", "the robot stands still, or run with --set odometry.enabled=false");
}

}  // namespace roomgraph
