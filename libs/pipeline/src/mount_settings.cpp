// SPDX-License-Identifier: BSD-3-Clause
// From turned ways and tilted floors to corrections of recorded poses, and to words.
#include "roomgraph/pipeline/mount_settings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

constexpr double kTurnedSigmas = 5;
constexpr double kSameTurn_rad = 0.0175;  // of two sensors against a third that is wrong

using enum MotionSensor;

Eigen::Quaterniond aboutUp(double rad) { return Eigen::Quaterniond(Eigen::AngleAxisd(rad, Eigen::Vector3d::UnitZ())); }

// What of three sensors is turned against both others.
std::optional<double> yawAgainstBoth(const TurnedBy& first, const TurnedBy& second) {
  if (!isTurned(first) || !isTurned(second) || std::abs(wrapAngle(first.rad - second.rad)) > kSameTurn_rad) return std::nullopt;
  return first.sigma_rad < second.sigma_rad ? first.rad : second.rad;
}

std::optional<double> certainYaw(const std::optional<TurnedBy>& by) { return isTurned(by) ? std::optional(by->rad) : std::nullopt; }

struct WrongYaws {
  std::optional<double> camera, lidar;
};

WrongYaws wrongYaws(const MovementAgreement& agreement, bool three) {
  const auto camera_lidar = agreement.turned(kCamera, kLidar), camera_wheels = agreement.turned(kCamera, kWheels), lidar_wheels = agreement.turned(kLidar, kWheels);
  if (camera_lidar && camera_wheels && lidar_wheels)
    return {yawAgainstBoth(*camera_wheels, *camera_lidar), yawAgainstBoth(*lidar_wheels, {-camera_lidar->rad, camera_lidar->sigma_rad})};
  if (three) return {};
  if (camera_wheels || lidar_wheels) return {certainYaw(camera_wheels), certainYaw(lidar_wheels)};
  return {certainYaw(camera_lidar), std::nullopt};
}

}  // namespace

bool isTurned(const std::optional<TurnedBy>& by) {
  return by && std::abs(by->rad) > std::max(kWrongYaw_rad, kTurnedSigmas * by->sigma_rad);
}

std::vector<MountSetting> wrongMounts(const MovementAgreement& agreement, const CameraTilt& tilt, const LabelsOfSensors& labels) {
  const WrongYaws yaws = wrongYaws(agreement, std::all_of(labels.begin(), labels.end(), [](const auto& label) { return label.has_value(); }));
  const auto label = [&](MotionSensor sensor) { return labels[static_cast<std::size_t>(sensor)].value_or(""); };
  std::vector<MountSetting> out;
  const auto up = tilt.up();
  const bool tilted = up && std::atan2(up->head<2>().norm(), up->z()) > kWrongTilt_rad;
  const Eigen::Quaterniond level = tilted ? Eigen::Quaterniond::FromTwoVectors(*up, Eigen::Vector3d::UnitZ()) : Eigen::Quaterniond::Identity();
  if (tilted || yaws.camera) out.push_back({kCamera, label(kCamera), aboutUp(-yaws.camera.value_or(0)) * level});
  if (yaws.lidar) out.push_back({kLidar, label(kLidar), aboutUp(-*yaws.lidar)});
  return out;
}

void addMounts(const std::vector<MountSetting>& found, std::vector<MountSetting>& mounts) {
  for (const MountSetting& one : found) {
    const auto known = std::find_if(mounts.begin(), mounts.end(),
                                    [&](const MountSetting& other) { return other.sensor == one.sensor && other.label == one.label; });
    if (known == mounts.end())
      mounts.push_back(one);
    else
      known->turn = (one.turn * known->turn).normalized();
  }
}

void addMounts(const std::vector<MountSetting>& mounts, RecordCorrections& corrections) {
  for (const MountSetting& mount : mounts) corrections.turns[mount.label] = mount.turn;
}

Finding mountFinding(const MountSetting& mount, bool set) {
  const Eigen::Matrix3d error = mount.turn.inverse().toRotationMatrix();
  const double yaw = std::atan2(error(1, 0), error(0, 0)), pitch = std::asin(std::clamp(-error(2, 0), -1.0, 1.0)), roll = std::atan2(error(2, 1), error(2, 2));
  char what[160];
  std::snprintf(what, sizeof what, "its recorded pose is turned by %.1f deg (yaw), %.1f (pitch), %.1f (roll)%s", yaw / kDegree, pitch / kDegree,
                roll / kDegree, set ? "; it was corrected" : "");
  const std::string place = mount.label.empty() ? toString(mount.sensor) : mount.label;
  return {Severity::kWarning, what, place, "'roomgraph calibrate RAWLOG -o calibration.ini' finds it once for all recordings"};
}

}  // namespace roomgraph
