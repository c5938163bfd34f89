// SPDX-License-Identifier: BSD-3-Clause
// From offsets of sensors to corrections of their records, and to words.
#include "roomgraph/pipeline/clock_settings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace roomgraph {
namespace {

constexpr const char* kOdometry = "odometry";
constexpr double kAlike = 0.3;  // share of an offset by which a jump may differ from it
constexpr double kExact_s = 0.01, kSigmas = 4;

bool isAbout(double seconds, double expected_s) { return std::abs(seconds - expected_s) < kAlike * std::abs(expected_s); }

// The jump that makes a clock seem wrong: its own, or the opposite one of a sensor that seems right. What was left out there is in a jump of
// stamps, so that it says more of the offset only where both are alike.
std::optional<ClockSetting> jumpLike(const ClockSetting& clock, const SensorClocks& clocks, const StampJumpsBySensor& jumps) {
  const bool by_lidar = clock.sensor != MotionSensor::kLidar && (clocks.isThere(MotionSensor::kLidar) || !clocks.isThere(MotionSensor::kCamera));
  const std::string own = clock.sensor == MotionSensor::kWheels ? kOdometry : clock.label;
  for (const auto& [label, all] : jumps)
    for (const StampJump& jump : all) {
      const double seconds = label == own ? clock.offset.seconds : -clock.offset.seconds;
      if (!isAbout(-jump.seconds, seconds)) continue;
      ClockSetting out = clock;
      if (label != own) {
        out.label = label == kOdometry ? "" : label;
        out.sensor = label == kOdometry ? MotionSensor::kWheels : (by_lidar ? MotionSensor::kLidar : MotionSensor::kCamera);
      }
      out.jumped = true;
      out.offset.seconds = std::abs(seconds + jump.seconds) < kExact_s + kSigmas * clock.offset.sigma ? -jump.seconds : seconds;
      return out;
    }
  return std::nullopt;
}

}  // namespace

std::vector<ClockSetting> wrongClocks(const FrontEnds& sensors) {
  std::vector<ClockSetting> out;
  const auto wrong = sensors.clocks().wrong();
  const auto& labels = sensors.labels();
  if (!wrong || sensors.shareLabel()) return out;
  for (std::size_t i = 0; i < wrong->size(); ++i)
    if ((*wrong)[i].seconds != 0) out.push_back({kMotionSensors[i], labels[i].value_or(""), (*wrong)[i]});
  return out;
}

std::vector<ClockSetting> settable(const std::vector<ClockSetting>& wrong, const SensorClocks& clocks, const StampJumpsBySensor& jumps) {
  std::vector<ClockSetting> out;
  for (const ClockSetting& clock : wrong) {
    if (auto jumped = jumpLike(clock, clocks, jumps))
      out.push_back(*jumped);
    else if (!clocks.agreed(clock.sensor))
      out.push_back(clock);
  }
  return out;
}

std::vector<ClockSetting> withoutCamera(const std::vector<ClockSetting>& clocks, const FrontEnds& sensors) {
  std::vector<ClockSetting> out;
  for (const ClockSetting& clock : clocks) {
    if (clock.sensor != MotionSensor::kCamera) {
      addClocks({clock}, out);
      continue;
    }
    if (clock.jumped) continue;
    for (const MotionSensor other : {MotionSensor::kLidar, MotionSensor::kWheels})
      if (sensors.clocks().isThere(other))
        addClocks({{other, sensors.labels()[static_cast<std::size_t>(other)].value_or(""), {-clock.offset.seconds, clock.offset.sigma}}}, out);
  }
  return out;
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
