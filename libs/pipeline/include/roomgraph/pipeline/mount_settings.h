// SPDX-License-Identifier: BSD-3-Clause
// Directions of sensors on the robot that a run found wrong, and sets when it begins anew.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/datasets/calibration_file.h"
#include "roomgraph/datasets/rawlog_report.h"
#include "roomgraph/estimation/camera_tilt.h"
#include "roomgraph/estimation/movement_agreement.h"
#include "roomgraph/pipeline/front_ends.h"

namespace roomgraph {

/// By what the recorded pose of a sensor is turned, about the sensor's own place and along the robot's axes, so that it is right.
struct MountSetting {
  MotionSensor sensor = MotionSensor::kCamera;
  std::string label;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  bool operator==(const MountSetting&) const = default;
};

/// By what a sensor is turned beside its recorded pose: a way that it saw, and the floor. From this on it is wrong.
constexpr double kWrongYaw_rad = 0.026, kWrongTilt_rad = 0.045;

/// Whether `by` is more than that, and certain.
bool isTurned(const std::optional<TurnedBy>& by);

/// Camera and lidar whose ways are turned against those of both others, or of the only other sensor: against wheels, else the camera against the
/// lidar; and the camera that sees the floor tilted. Where some were set before, what is left. Of three sensors that are there all must have been compared.
std::vector<MountSetting> wrongMounts(const MovementAgreement& agreement, const CameraTilt& tilt, const LabelsOfSensors& labels);

/// Adds to what is there.
void addMounts(const std::vector<MountSetting>& found, std::vector<MountSetting>& mounts);
void addMounts(const std::vector<MountSetting>& mounts, RecordCorrections& corrections);

/// "its recorded pose is turned by 8.0 deg (yaw), 0.0 (pitch), 0.0 (roll)", and whether the run corrected it.
Finding mountFinding(const MountSetting& mount, bool set);

}  // namespace roomgraph
