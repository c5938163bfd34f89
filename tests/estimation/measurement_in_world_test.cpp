// SPDX-License-Identifier: BSD-3-Clause
// Covariance of a measurement in the world: by hand for a quarter turn, by sampling for any pose.
#include "measurement_in_world.h"

#include <gtest/gtest.h>

#include <cmath>

#include "random_poses.h"
#include "roomgraph/geometry/ground.h"

namespace roomgraph::test {
namespace {

ObjectMeasurement measurementWith(const Eigen::Matrix4d& covariance) {
  ObjectMeasurement out;
  out.proposal.camera_from_object = poseFromYpr(0.2, 0.9, 3, 0, 0, 0);
  out.proposal.covariance = covariance;
  return out;
}

Pose3 cameraLooking(double x, double y, double heading) {
  Pose3 out = poseFromYpr(x, y, 1.1, heading, 0, 0);
  out.linear() = out.linear() * bodyFromOptical();
  return out;
}

// The camera looks along world y: what is uncertain ahead of it is uncertain along y, what it says of the left
// along -x.
TEST(MeasurementInWorld, AQuarterTurnByHand) {
  Eigen::Matrix4d ahead = Eigen::Matrix4d::Zero();
  ahead.diagonal() << 0.09, 0.01, 0.0004, 0.2;
  ahead(0, 1) = ahead(1, 0) = 0.02;
  const auto seen =
      measurementInWorld(measurementWith(ahead), {320, 240, 260, 260, 159.5, 119.5, {}},
                         cameraLooking(4, -2, M_PI / 2), 0.1);
  EXPECT_NEAR(seen.covariance(0, 0), 0.01 + 0.01, 1e-12) << "and the pose's";
  EXPECT_NEAR(seen.covariance(1, 1), 0.09 + 0.01, 1e-12);
  EXPECT_NEAR(seen.covariance(0, 1), -0.02, 1e-12);
  EXPECT_NEAR(seen.covariance(2, 2), 0.0004, 1e-12);
  EXPECT_NEAR(seen.covariance(3, 3), 0.2, 1e-12);
}

// Places scattered in the ground frame under the camera, taken to the world one by one.
TEST(MeasurementInWorld, CovarianceIsThatOfTheScatteredPlaces) {
  Random random(11);
  for (int trial = 0; trial < 5; ++trial) {
    const Pose3 world_from_camera = cameraLooking(random.uniform(-3, 3), 1, random.uniform(-3, 3));
    Eigen::Matrix4d root = Eigen::Matrix4d::Zero();
    root(0, 0) = 0.3;
    root(1, 0) = random.uniform(-0.2, 0.2);
    root(1, 1) = 0.05;
    root(2, 2) = 0.01;
    root(3, 3) = 0.1;
    const auto seen = measurementInWorld(measurementWith(root * root.transpose()), {}, world_from_camera, 0);
    const Pose3 world_from_ground = world_from_camera * cameraFromGround(groundInCamera(world_from_camera));
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    constexpr int kSamples = 40000;
    const auto unit = [&] { return random.uniform(-std::sqrt(3), std::sqrt(3)); };  // variance 1
    for (int i = 0; i < kSamples; ++i) {
      const double a = unit(), b = unit(), c = unit();
      const Eigen::Vector3d offset = root.topLeftCorner<3, 3>() * Eigen::Vector3d(a, b, c);
      const Eigen::Vector3d moved = world_from_ground * offset - world_from_ground.translation();
      scatter += moved * moved.transpose() / kSamples;
    }
    EXPECT_LT((scatter - seen.covariance.topLeftCorner<3, 3>()).norm(), 0.03 * scatter.norm()) << trial;
  }
}

}  // namespace
}  // namespace roomgraph::test
