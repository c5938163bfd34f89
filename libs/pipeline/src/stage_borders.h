// SPDX-License-Identifier: BSD-3-Clause
// What has to hold where one stage hands its values to the next; checked in every run, in every build.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "roomgraph/datasets/record_stream.h"
#include "roomgraph/estimation/pose_estimator.h"
#include "roomgraph/observations/detection.h"
#include "roomgraph/observations/proposal.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// Whether a record has a time, so that it has a place among the others.
bool hasTime(const Record& record);

/// Why a record cannot be used ("frame: pose of its sensor is not finite"); empty when it can be. Those of
/// rawlogs have passed the stricter checks of their reader; a driver, a plug-in or a test brings its own.
std::string problemOfRecord(const Record& record);

/// Why a box of a detector is none; empty when it is one. Sides in any order of pixels, but finite; score in
/// [0, 1].
std::string problemOfDetection(const Detection& detection);

/// Why a measurement of an object cannot be used; empty when it can be: its shape, its pose in the camera (a
/// rigid motion), the covariance of (x, y, z, yaw), its confidence in [0, 1].
std::string problemOfMeasurement(const ObjectMeasurement& measurement);

/// Why a square matrix is no covariance: not finite, not symmetric (to 1e-6 of its largest element), not
/// positive definite (by its Cholesky decomposition); empty when it is one.
std::string problemOfCovariance(const Eigen::Ref<const Eigen::MatrixXd>& covariance);

/// Why a movement between two times is none: the times, its pose, its covariance (of x, y and yaw alone where
/// nothing else was measured); empty when it is one.
std::string problemOfMovement(const RelativePose& movement);

/// Throws RunError, which names the record and the stage, when the pose is not finite or no rigid motion.
void requirePose(const Pose3& world_from_robot, const Record& record);

/// What the back end has found. Throws RunError, which names the landmark, when a place is not finite or too
/// far away.
const LandmarkEstimates& sound(const LandmarkEstimates& landmarks);

/// Expected failures by reason, as a run counts them.
using Reasons = std::map<std::string, int>;

/// Whether there is a problem; it is counted then, with the stage that brought it.
bool isBroken(const char* stage, const std::string& problem, Reasons& reasons);

/// Those without a problem; the others are counted.
std::vector<Detection> withoutBroken(std::vector<Detection> boxes, Reasons& reasons);
std::vector<RelativePose> withoutBroken(std::vector<RelativePose> closures, Reasons& reasons);

}  // namespace roomgraph
