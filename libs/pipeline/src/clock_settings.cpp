// SPDX-License-Identifier: BSD-3-Clause
// From offsets of sensors to corrections of their records, and to words.
#include "roomgraph/pipeline/clock_settings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace roomgraph {
namespace {

constexpr const char* kOdometry = "odometry";
constexpr double kAlike = 0.3;  // share of a jump by which an offset may differ from it

}  // namespace

std::vector<ClockSetting> wrongClocks(const FrontEnds& sensors) {
  std::vector<ClockSetting> out;
  const auto wrong = sensors.clocks().wrong();
  const auto& labels = sensors.labels();
  if (!wrong || labels[0] == labels[1]) return out;  // a label that two sensors have names none
  for (std::size_t i = 0; i < wrong->size(); ++i)
    if ((*wrong)[i].seconds != 0) out.push_back({kMotionSensors[i], labels[i], (*wrong)[i]});
  return out;
}

bool canBeSet(const SensorClocks& clocks) { return !clocks.agreed() || clocks.jumped(); }

std::vector<ClockSetting> withJumps(std::vector<ClockSetting> wrong, const SensorClocks& clocks, const ReadStatistics& read) {
  for (ClockSetting& clock : wrong) {
    const auto found = read.stamp_jumps.find(clock.label.empty() ? kOdometry : clock.label);
    if (found == read.stamp_jumps.end()) continue;
    for (const double jump_s : found->second) {
      if (std::abs(jump_s + clock.offset.seconds) > kAlike * std::abs(jump_s)) continue;
      clock.jumped = true;
      clock.offset.seconds = -jump_s;  // which the stamps say better
    }
  }
  if (clocks.agreed()) std::erase_if(wrong, [](const ClockSetting& clock) { return !clock.jumped; });
  return wrong;
}

void addClocks(const std::vector<ClockSetting>& found, std::vector<ClockSetting>& clocks) {
  for (const ClockSetting& one : found) {
    const auto known = std::find_if(clocks.begin(), clocks.end(),
                                    [&](const ClockSetting& other) { return other.sensor == one.sensor && other.label == one.label && other.jumped == one.jumped; });
    if (known == clocks.end())
      clocks.push_back(one);
    else
      known->offset = {known->offset.seconds + one.offset.seconds, one.offset.sigma};
  }
}

void addClocks(const std::vector<ClockSetting>& clocks, RecordCorrections& corrections) {
  for (const ClockSetting& clock : clocks) {
    const bool wheels = clock.sensor == MotionSensor::kWheels;
    auto& by_label = clock.jumped ? corrections.time_jumps_s : corrections.time_offsets_s;
    auto& of_wheels = clock.jumped ? corrections.wheels_time_jump_s : corrections.wheels_time_offset_s;
    (wheels ? of_wheels : by_label[clock.label]) += clock.offset.seconds;
  }
}

bool isSet(const ClockSetting& clock, const ReadStatistics& read) {
  const std::string what = "stamp of " + (clock.label.empty() ? kOdometry : "'" + clock.label + "'");
  return std::any_of(read.corrected.begin(), read.corrected.end(), [&](const auto& one) { return one.first.starts_with(what); });
}

Finding clockFinding(const ClockSetting& clock, bool set) {
  char what[160];
  std::snprintf(what, sizeof what, "its stamps are %.3f s (+- %.3f) too %s against those of the others%s%s", std::abs(clock.offset.seconds),
                clock.offset.sigma, clock.offset.seconds < 0 ? "late" : "early", clock.jumped ? ", since they jumped" : "", set ? "; they were corrected" : "");
  const std::string place = clock.label.empty() ? toString(clock.sensor) : clock.label;
  return {Severity::kWarning, what, place,
          set ? "'roomgraph calibrate RAWLOG -o calibration.ini' finds it once for all recordings"
              : "'roomgraph calibrate RAWLOG -o calibration.ini' finds it, and takes it out"};
}

}  // namespace roomgraph
