// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/pipeline/sighting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roomgraph {

LandmarkFactor sightingOf(const ObjectDecision& decision, const Landmark& landmark, const KeyPose& node,
                          const Pose3& node_from_camera) {
  const auto& measurement = decision.seen.measurement;
  const Pose3 node_from_object = node_from_camera * measurement.proposal.camera_from_object;
  LandmarkFactor factor{.node = node.id, .landmark = landmark.id};
  factor.position_in_robot = node_from_object.translation();
  factor.has_yaw = measurement.proposal.has_yaw;
  const double node_yaw = planarPart(node.world_from_robot).yaw;
  factor.yaw_in_robot = wrapAngle(planarPart(node.world_from_robot * node_from_object).yaw - node_yaw);
  if (std::abs(wrapAngle(node_yaw + factor.yaw_in_robot - landmark.yaw)) > std::numbers::pi / 2)
    factor.yaw_in_robot = wrapAngle(factor.yaw_in_robot + std::numbers::pi);
  Eigen::Matrix4d turn = Eigen::Matrix4d::Identity();
  turn.topLeftCorner<3, 3>() = node.world_from_robot.linear().transpose();
  factor.covariance = turn * decision.seen.covariance * turn.transpose();
  factor.weight = decision.association.probability * measurement.confidence * measurement.proposal.score;
  return factor;
}

LandmarkFactor meanSighting(const std::vector<LandmarkFactor>& sightings) {
  LandmarkFactor mean = sightings.front();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double sum = 0;
  for (const auto& s : sightings) {
    const double share = std::max(s.weight, 1e-9) / s.covariance.topLeftCorner<2, 2>().trace();
    position += share * s.position_in_robot;
    covariance += share * s.covariance;
    sum += share;
    if (s.has_yaw) direction += share * Eigen::Vector2d(std::cos(s.yaw_in_robot), std::sin(s.yaw_in_robot));
    mean.weight = std::max(mean.weight, s.weight);
  }
  mean.position_in_robot = position / sum;
  mean.covariance = covariance / sum;
  mean.has_yaw = direction.norm() > 1e-9;
  if (mean.has_yaw) mean.yaw_in_robot = std::atan2(direction.y(), direction.x());
  return mean;
}

}  // namespace roomgraph
