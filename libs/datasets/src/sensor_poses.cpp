// SPDX-License-Identifier: BSD-3-Clause
// Parser of "LABEL=x,y,z,yaw,pitch,roll" lists in metres and degrees.
#include "roomgraph/datasets/sensor_poses.h"

#include <mrpt/math/TPose3D.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <vector>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/trim.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

constexpr double kFarthestM = 1000;

std::vector<std::string> splitAtCommas(const std::string& text) {
  std::vector<std::string> items;
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');) items.push_back(trim(item));
  if (!text.empty() && text.back() == ',') items.emplace_back();
  return items;
}

Pose3 poseOf(const std::vector<std::string>& numbers, const std::string& context) {
  const auto refuse = [&](const std::string& why) {
    return ConfigError(context + ": " + why + "; expected x,y,z,yaw,pitch,roll in metres and degrees");
  };
  if (numbers.size() != 6) throw refuse(std::to_string(numbers.size()) + " numbers instead of 6");
  std::array<double, 6> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    const std::string& text = numbers[i];
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v[i]);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(v[i]))
      throw refuse("'" + text + "' is not a number");
  }
  if (std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}) > kFarthestM)
    throw refuse("the sensor is more than 1 km away from the robot");
  return poseFromYpr(v[0], v[1], v[2], v[3] * kDegree, v[4] * kDegree, v[5] * kDegree);
}

}  // namespace

Pose3 parsePose(const std::string& text, const std::string& context) {
  return poseOf(splitAtCommas(text), context);
}

SensorPoses parseSensorPoses(const std::string& text, const std::string& context) {
  std::vector<std::pair<std::string, std::vector<std::string>>> entries;
  for (const std::string& item : splitAtCommas(text)) {
    const auto equals = item.rfind('=');
    if (equals != std::string::npos) entries.push_back({trim(item.substr(0, equals)), {}});
    if (entries.empty())
      throw ConfigError(context + ": '" + text + "' names no sensor; expected LABEL=x,y,z,yaw,pitch,roll");
    entries.back().second.push_back(equals == std::string::npos ? item : trim(item.substr(equals + 1)));
  }
  SensorPoses poses;
  for (const auto& [label, numbers] : entries)
    poses.insert_or_assign(label, poseOf(numbers, context + ": sensor '" + label + "'"));
  return poses;
}

std::string formatPose(const Pose3& pose) {
  const mrpt::math::TPose3D p = toMrpt(pose).asTPose();
  const auto rounded = [](double value, double steps) { return std::round(value * steps) / steps + 0.0; };
  char text[160];
  std::snprintf(text, sizeof text, "%g,%g,%g,%g,%g,%g", rounded(p.x, 1000), rounded(p.y, 1000),
                rounded(p.z, 1000), rounded(p.yaw / kDegree, 100), rounded(p.pitch / kDegree, 100),
                rounded(p.roll / kDegree, 100));
  return text;
}

}  // namespace roomgraph
