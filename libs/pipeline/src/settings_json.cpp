// SPDX-License-Identifier: BSD-3-Clause
// Fields of clock and mount settings.
#include "roomgraph/pipeline/settings_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

MotionSensor sensorNamed(const std::string& name) {
  const auto sensor = std::find_if(kMotionSensors.begin(), kMotionSensors.end(), [&](MotionSensor one) { return name == toString(one); });
  if (sensor == kMotionSensors.end()) throw InputError("no sensor: " + name);
  return *sensor;
}

}  // namespace

nlohmann::ordered_json jsonOf(const ClockSetting& clock) {
  return {{"sensor", toString(clock.sensor)}, {"label", clock.label}, {"since_a_jump", clock.jumped},
          {"added_s", clock.offset.seconds}, {"sigma_s", clock.offset.sigma}};
}

nlohmann::ordered_json jsonOf(const MountSetting& mount) {
  return {{"sensor", toString(mount.sensor)}, {"label", mount.label}, {"turned_by_wxyz", {mount.turn.w(), mount.turn.x(), mount.turn.y(), mount.turn.z()}}};
}

ClockSetting clockFrom(const nlohmann::ordered_json& json) {
  return {sensorNamed(json.at("sensor")), json.at("label"), {json.at("added_s"), json.at("sigma_s")}, json.at("since_a_jump")};
}

MountSetting mountFrom(const nlohmann::ordered_json& json) {
  const auto& turn = json.at("turned_by_wxyz");
  return {sensorNamed(json.at("sensor")), json.at("label"), Eigen::Quaterniond(turn.at(0).get<double>(), turn.at(1).get<double>(), turn.at(2).get<double>(), turn.at(3).get<double>())};
}

}  // namespace roomgraph
