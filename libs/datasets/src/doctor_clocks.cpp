// SPDX-License-Identifier: BSD-3-Clause
// Checks for unsynchronised sensor clocks and disjoint time spans.
#include <algorithm>
#include <cmath>

#include "findings.h"

namespace roomgraph {
namespace {

constexpr double kApartS = 1;
constexpr int kLeastRecords = 5;

double intervalOf(const RawlogReport& report, const std::string& label) {
  for (const auto& sensor : report.sensors)
    if (sensor.used && sensor.label == label) return sensor.median_interval_s;
  return 0;
}

// Against what stands beside the records in the file.
bool checkOffset(const RawlogReport& report, const SensorReport& sensor, Findings& out) {
  if (!sensor.clock_offset) return true;
  const double first = sensor.clock_offset->first_s, last = sensor.clock_offset->last_s;
  const std::string& reference = sensor.clock_offset->reference;
  const double tolerance = kApartS + intervalOf(report, reference);
  if (const double step = sensor.clock_offset->step_s; step != 0)
    out.warning(
        format("its clock jumps by %+.2f s against that of %s at t = %.3f s", step, reference.c_str(),
               sensor.clock_offset->step_time),
        "all sensors must be stamped by one clock: cut the recording there, or shift the stamps behind");
  if (std::max(std::abs(first), std::abs(last)) < tolerance) return true;
  if (std::abs(last - first) > tolerance)
    out.error(format("its clock runs at another speed than that of %s: %.1f s apart at first, %.1f s at last",
                     reference.c_str(), first, last),
              "all sensors must be stamped by one clock, in seconds");
  else
    out.error(format("its clock is %.1f s apart from that of %s", (first + last) / 2, reference.c_str()),
              "all sensors must be stamped by one clock: shift the stamps of one of them");
  return false;
}

bool checkSpan(const SensorReport& a, const SensorReport& b, Findings& out) {
  const double between = std::max(a.first_time, b.first_time) - std::min(a.last_time, b.last_time);
  if (between < kApartS) return true;
  out.error(format("has no time in common with %s: its records end %.1f s before the others begin",
                   nameOf(a.last_time < b.last_time ? b : a).c_str(), between),
            "all sensors must be stamped by one clock; if they really took turns, use one at a time");
  return false;
}

}  // namespace

bool checkClocks(const RawlogReport& report, Findings& out) {
  std::vector<const SensorReport*> sensors;
  for (const auto& sensor : report.sensors)
    if (sensor.used && sensor.count - sensor.invalid_times >= kLeastRecords) sensors.push_back(&sensor);
  bool together = true;
  for (std::size_t i = 1; i < sensors.size(); ++i) {
    const SensorReport &reference = *sensors.front(), &sensor = *sensors[i];
    out.at(nameOf(sensor));
    const bool good = checkOffset(report, sensor, out);
    if (good) {
      const bool earlier = sensor.last_time < reference.last_time;
      out.at(nameOf(earlier ? sensor : reference));
      together = checkSpan(reference, sensor, out) && together;
    }
    together = together && good;
  }
  out.at("file");
  return together;
}

}  // namespace roomgraph
