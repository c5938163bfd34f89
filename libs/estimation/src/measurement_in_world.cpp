// SPDX-License-Identifier: BSD-3-Clause
// Rotation of a proposal's covariance from the camera's ground frame into the world.
#include "measurement_in_world.h"

#include "roomgraph/geometry/covariance.h"
#include "roomgraph/geometry/ground.h"

namespace roomgraph {

WorldMeasurement measurementInWorld(const ObjectMeasurement& measurement, const PinholeCamera& camera,
                                    const Pose3& world_from_camera, double pose_sigma_m) {
  WorldMeasurement out{measurement, world_from_camera * measurement.proposal.camera_from_object, {}, camera};
  const Pose3 world_from_ground = world_from_camera * cameraFromGround(groundInCamera(world_from_camera));
  const double heading = planarPart(world_from_ground).yaw;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(heading).toRotationMatrix();
  out.covariance = rotateCovariance(measurement.proposal.covariance, turn);
  out.covariance.topLeftCorner<2, 2>() += pose_sigma_m * pose_sigma_m * Eigen::Matrix2d::Identity();
  return out;
}

}  // namespace roomgraph
