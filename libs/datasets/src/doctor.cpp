// SPDX-License-Identifier: BSD-3-Clause
// Problems of a recording as a whole: scan aperture, kinds of sensors, unused records; order of all checks.
#include <algorithm>
#include <array>
#include <cmath>

#include "findings.h"
#include "roomgraph/geometry/degree.h"
#include "sensor_choice.h"

namespace roomgraph {
namespace {

/// Whether an angle is a usual step between beams: 1/12 deg to 2 deg, or a circle cut into 2^n.
bool usualStep(double degrees) {
  constexpr std::array<double, 12> kSteps = {2,       1,    0.5,  0.25, 0.125, 1 / 3.0,
                                             1 / 6.0, 0.36, 0.72, 0.2,  0.1,   360 / 1024.0};
  return std::any_of(kSteps.begin(), kSteps.end(),
                     [&](double s) { return std::abs(degrees / s - 1) < 5e-4; });
}

void checkAperture(const ScanSummary& scans, Findings& out) {
  const double aperture = scans.aperture_rad;
  if (!(aperture > 0) || aperture > 2 * M_PI + 0.01) {
    out.error(format("aperture of %.4f rad is impossible", aperture),
              "aperture is in radians, first beam to last");
    return;
  }
  if (scans.beams < 2) return;
  const double step = aperture / (scans.beams - 1) * kDegreesPerRadian,
               rival = aperture / scans.beams * kDegreesPerRadian;
  // A full circle may count the beam at which it closes once or twice.
  const bool full_circle = 360 - aperture * kDegreesPerRadian < 1.01 * step;
  if (!full_circle && !usualStep(step) && usualStep(rival))
    out.note(
        format("%d beams over %.2f deg are %.4f deg apart; with one interval more it would be %.4f",
               scans.beams, aperture * kDegreesPerRadian, step, rival),
        "aperture is the angle from the first beam to the last: (beams - 1) * step; check which was meant");
  if (!scans.rotation_ratio) return;
  if (*scans.rotation_ratio < 0)
    out.warning("scans turn the same way as the robot: they are mirrored",
                "check rightToLeft, and whether it is mounted upside down as its recorded pose says");
  else if (std::abs(*scans.rotation_ratio - 1) > 0.15)
    out.warning(format("odometry turns %.2f times as much as the scans show", *scans.rotation_ratio),
                format("if odometry is right, the aperture is %.1f deg instead of %.1f",
                       aperture * kDegreesPerRadian * *scans.rotation_ratio, aperture * kDegreesPerRadian));
}

void checkScans(const SensorReport& sensor, Findings& out) {
  const auto& scans = *sensor.scans;
  checkAperture(scans, out);
  if (scans.not_finite > 0)
    out.warning(format("%zu ranges are marked valid and are NaN or infinite", scans.not_finite),
                "they are taken for beams without return");
  if (scans.noisy.count > 0)
    out.warning(format("%d of %d scans are much noisier than the others; first at t = %.3f s",
                       scans.noisy.count, sensor.count, scans.noisy.first_time),
                "what is measured in them is doubtful");
  if (scans.beams_change) out.note("the number of beams changes", "each scan is read with its own");
  if (scans.beams == 0)
    out.error("scans without beams", "check the driver or the conversion");
  else if (scans.at_max_share > 0.99)
    out.error(format("all ranges are at the maximum (%.2f m)", scans.max_range_m),
              "check the unit of the ranges, and maxRange");
  else if (scans.valid_share == 0)
    out.error("all ranges are invalid", "check the unit of the ranges, and the validity flags");
  else if (scans.valid_share < 0.05)
    out.warning(format("only %.1f %% of the beams have a return", 100 * scans.valid_share), "check maxRange");
  if (!(scans.max_range_m > 0))
    out.note("maximum range is not set", "beams without return cannot be told apart");
}

// As the reader will choose.
void checkKinds(const RawlogReport& report, Findings& out) {
  SensorChoices choices;
  for (const auto& sensor : report.sensors) {
    if (sensor.count == sensor.invalid_times) continue;
    if (sensor.images) choices.rgbd.takes(sensor.label);
    if (sensor.scans) choices.lidar.takes(sensor.label);
    if (sensor.odometry) choices.odometry.takes(sensor.label);
  }
  for (const auto* choice : {&choices.rgbd, &choices.lidar, &choices.odometry})
    if (const auto what = choice->what(); !what.empty()) out.warning(what, choice->hint());
}

// Of all sensors together.
void checkTime(const std::vector<ClockSetBack>& set_back, Findings& out) {
  constexpr const char* kHint = "a run adds it to the stamps from there on (not with boxes that are kept apart from their images)";
  if (set_back.empty()) return;
  out.at("all sensors");
  const std::string first = format("their clock is set back by %.2f s at t = %.3f s", set_back[0].seconds, set_back[0].t + set_back[0].seconds);
  out.warning(set_back.size() == 1 ? first : first + format(", the first of %zu times", set_back.size()), kHint);
}

void checkWhole(const RawlogReport& report, Findings& out) {
  constexpr double kLargeStepBackS = 1;
  const auto has = [&](auto predicate) {
    return std::any_of(report.sensors.begin(), report.sensors.end(), predicate);
  };
  out.at("file");
  checkKinds(report, out);
  if (!report.truncation.empty()) out.warning(report.truncation, "what comes before is used");
  for (const auto& [reason, count] : report.skipped)
    out.warning(format("%d x %s", count, reason.c_str()), "such records are left out");
  if (!has([](const SensorReport& s) { return s.images || s.scans; }))
    out.error("no usable sensor", "needs CObservation3DRangeScan (RGB-D) or CObservation2DRangeScan (lidar)");
  else if (!has([](const SensorReport& s) { return s.odometry.has_value(); }))
    out.note("no odometry", "movement is found from images or scans alone");
  if (checkClocks(report, out) && report.largest_step_back_s > kLargeStepBackS)
    out.warning(
        format("records are out of order by up to %.3f s between sensors", report.largest_step_back_s),
        "sort the records by time stamp and save again");
}

}  // namespace

std::vector<Finding> findProblems(const RawlogReport& report) {
  Findings out;
  checkWhole(report, out);
  checkTime(report.clocks_set_back, out);
  const bool on_robot = std::any_of(report.sensors.begin(), report.sensors.end(),
                                    [](const SensorReport& s) { return s.scans || s.odometry; });
  for (const auto& sensor : report.sensors) {
    out.at(nameOf(sensor));
    if (!sensor.used) {
      out.note(format("%d records of class %s are not used", sensor.count, sensor.class_name.c_str()), "");
      continue;
    }
    checkTimes(report, sensor, out);
    checkRepetition(sensor, out);
    const bool unit_is_right = !sensor.images || checkImages(sensor, out);
    checkPose(sensor, on_robot, unit_is_right, out);
    if (sensor.scans) checkScans(sensor, out);
    if (sensor.odometry) checkOdometry(report, sensor, out);
  }
  return out.sorted();
}

}  // namespace roomgraph
