// SPDX-License-Identifier: BSD-3-Clause
// Strict reading of calibration files.
#include "roomgraph/datasets/calibration_file.h"

#include <cmath>
#include <stdexcept>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/ini_text.h"
#include "roomgraph/core/parameters.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/core/trim.h"

namespace roomgraph {
namespace {

constexpr double kLongestOffset_s = 10;
constexpr const char* kSensorSection = "sensor ";

struct Number {
  double* value;
  ParameterInfo info;
};

using Numbers = std::map<std::string, Number>;

ParameterInfo within(double min, double max) {
  return {.min = min, .max = max};
}

void readNumber(const IniEntry& entry, const Numbers& known) {
  const auto found = known.find(entry.key);
  if (found == known.end()) {
    std::vector<std::string> keys;
    for (const auto& [key, number] : known) keys.push_back(key);
    throw ConfigError(entry.place + ": [" + entry.section + "] unknown key '" + entry.key + "'" +
                      didYouMean(entry.key, keys) + "; known: " + join(keys));
  }
  try {
    parseParameter(entry.value, found->second.info, *found->second.value);
  } catch (const std::invalid_argument& error) {
    throw ConfigError(entry.place + ": [" + entry.section + "] " + entry.key + " = " + entry.value + ": " +
                      error.what());
  }
}

void readSensor(const IniEntry& entry, const std::string& label, Calibration& out) {
  if (entry.key == "pose") {
    out.poses[label] = parsePose(entry.value, entry.place + ": [" + entry.section + "] pose");
    return;
  }
  double unused = 0;
  const ParameterInfo offset = within(-kLongestOffset_s, kLongestOffset_s);
  if (entry.key != "time_offset_s")
    readNumber(entry, {{"pose", {&unused, {}}}, {"time_offset_s", {&unused, offset}}});
  readNumber(entry, {{"time_offset_s", {&out.corrections.time_offsets_s[label], offset}}});
}

}  // namespace

Calibration readCalibration(const std::filesystem::path& file) {
  Calibration out;
  auto& corrections = out.corrections;
  const std::map<std::string, Numbers> sections{
      {"wheels",
       {{"scale", {&corrections.wheels.scale, within(0.5, 2)}},
        {"turn_scale", {&corrections.wheels.turn_scale, within(0.5, 2)}},
        {"drift_rad_m", {&corrections.wheels.drift_rad_m, within(-1, 1)}},
        {"time_offset_s", {&corrections.wheels_time_offset_s, within(-kLongestOffset_s, kLongestOffset_s)}}}},
      {"depth",
       {{"scale", {&corrections.depth.scale, within(0.5, 2)}},
        {"bias_m", {&corrections.depth.bias_m, within(-1, 1)}}}}};
  for (const IniEntry& entry : parseIniFile(file)) {
    const auto section = sections.find(entry.section);
    if (section != sections.end())
      readNumber(entry, section->second);
    else if (entry.section.starts_with(kSensorSection))
      readSensor(entry, trim(entry.section.substr(std::string(kSensorSection).size())), out);
    else
      throw ConfigError(entry.place + ": unknown section [" + entry.section +
                        "]; known: [sensor LABEL], [wheels], [depth]");
  }
  return out;
}

// On an arc the chord keeps its direction relative to half the turn; both follow from the arc's own length
// and angle.
Pose2 corrected(const Pose2& movement, const WheelCorrection& correction) {
  const auto chordShare = [](double angle) {
    return std::abs(angle) < 1e-6 ? 1 : std::sin(angle / 2) / (angle / 2);
  };
  const double half = movement.yaw / 2, along = std::cos(half) * movement.x + std::sin(half) * movement.y,
               aside = -std::sin(half) * movement.x + std::cos(half) * movement.y;
  const double length = along / chordShare(movement.yaw) * correction.scale;
  const double turn = correction.turn_scale * movement.yaw + correction.drift_rad_m * length;
  const double new_along = length * chordShare(turn), new_aside = aside * correction.scale;
  const double c = std::cos(turn / 2), s = std::sin(turn / 2);
  return {c * new_along - s * new_aside, s * new_along + c * new_aside, wrapAngle(turn)};
}

}  // namespace roomgraph
