// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/pipeline/object_mapper.h"

#include <set>

#include "roomgraph/geometry/ground.h"
#include "roomgraph/pipeline/visibility.h"

namespace roomgraph {
namespace {

// Proposal covariances are in the ground frame under the camera (x ahead, y left, z up): turn them by its
// heading.
WorldMeasurement toWorld(const ObjectMeasurement& measurement, const Pose3& world_from_camera,
                         double pose_sigma_m) {
  WorldMeasurement out{measurement, world_from_camera * measurement.proposal.camera_from_object, {}};
  const Pose3 world_from_ground = world_from_camera * cameraFromGround(groundInCamera(world_from_camera));
  const double heading = planarPart(world_from_ground).yaw;
  Eigen::Matrix4d turn = Eigen::Matrix4d::Identity();
  turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(heading).toRotationMatrix();
  out.covariance = turn * measurement.proposal.covariance * turn.transpose();
  out.covariance.topLeftCorner<2, 2>() += pose_sigma_m * pose_sigma_m * Eigen::Matrix2d::Identity();
  return out;
}

LandmarkFactor sightingOf(const ObjectDecision& decision, const PosedFrame& posed) {
  const auto& proposal = decision.seen.measurement.proposal;
  const Pose3 node_from_object =
      posed.node_from_robot * posed.frame.robot_from_camera * proposal.camera_from_object;
  LandmarkFactor factor;
  factor.node = posed.node.id;
  factor.landmark = decision.landmark;
  factor.position_in_robot = node_from_object.translation();
  factor.yaw_in_robot = wrapAngle(planarPart(decision.seen.world_from_object).yaw -
                                  planarPart(posed.world_from_robot * posed.node_from_robot.inverse()).yaw);
  factor.has_yaw = proposal.has_yaw;
  Eigen::Matrix4d turn = Eigen::Matrix4d::Identity();
  turn.topLeftCorner<3, 3>() = posed.node.world_from_robot.linear().transpose();
  factor.covariance = turn * decision.seen.covariance * turn.transpose();
  factor.weight = decision.association.probability * decision.seen.measurement.confidence * proposal.score;
  return factor;
}

}  // namespace

std::vector<ObjectDecision> mapObjects(const std::vector<ObjectMeasurement>& measurements,
                                       const PosedFrame& posed, double pose_sigma_m, Associator& associator,
                                       LandmarkMap& landmarks, std::vector<LandmarkFactor>& sightings) {
  const Pose3 world_from_camera = posed.world_from_robot * posed.frame.robot_from_camera;
  std::vector<WorldMeasurement> seen;
  for (const auto& measurement : measurements)
    seen.push_back(toWorld(measurement, world_from_camera, pose_sigma_m));
  std::vector<ObjectDecision> decisions;
  for (const auto& association : associator.associate(seen, landmarks.landmarks())) {
    ObjectDecision decision{seen[association.measurement], association, {}};
    decision.landmark = landmarks.update(decision.seen, association);
    const LandmarkFactor sighting = sightingOf(decision, posed);
    if (sighting.weight > 1e-3) sightings.push_back(sighting);
    decisions.push_back(std::move(decision));
  }
  return decisions;
}

void missUnseen(const std::vector<ObjectDecision>& decisions, const std::vector<Detection>& detections,
                const PosedFrame& posed, LandmarkMap& landmarks) {
  std::set<LandmarkId> seen;
  for (const auto& decision : decisions) seen.insert(decision.landmark);
  const Pose3 world_from_camera = posed.world_from_robot * posed.frame.robot_from_camera;
  std::vector<LandmarkId> missed;
  for (const auto& landmark : landmarks.landmarks())
    if (!seen.contains(landmark.id) && shouldBeSeen(landmark, posed.frame, world_from_camera, detections))
      missed.push_back(landmark.id);
  for (const auto id : missed) landmarks.miss(id);
}

}  // namespace roomgraph
