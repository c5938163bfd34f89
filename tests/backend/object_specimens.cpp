// SPDX-License-Identifier: BSD-3-Clause
// Exact and hand-computed states of point, box, size and marginal prior residuals.
#include "object_specimens.h"

#include "object_views.h"
#include "roomgraph/geometry/projection.h"

namespace roomgraph::test {
namespace {

std::vector<double> numbers(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
std::vector<double> sizeBlock(const ObjectShape& shape) {
  return {shape.width, shape.depth, shape.height};
}

// A camera 1 m above the robot's origin, looking along its x axis.
Pose3 forwardCamera() {
  Pose3 pose = Pose3::Identity();
  pose.linear() = bodyFromOptical();
  pose.translation().z() = 1;
  return pose;
}

// One pose, one landmark, one point.
MarginalPrior priorOver(const Pose3& pose, const LandmarkEstimate& landmark, const Eigen::Vector3d& point,
                        int rows) {
  MarginalPrior prior;
  prior.variables = {{NodeId{0}}, {LandmarkId{0}}, {PointId{0}}};
  prior.poses = {pose};
  prior.landmarks = {landmark};
  prior.points = {point};
  prior.root = Eigen::MatrixXd::Zero(rows, 16);
  prior.offset = Eigen::VectorXd::Zero(rows);
  return prior;
}

}  // namespace

Specimen sizeAtMeasurement(Random& random) {
  const Eigen::Vector3d size = random.vector(1) + Eigen::Vector3d::Constant(1.5);
  return {sharedCost(LandmarkSizeFactor{{}, size, {0.1, 0.2, 0.3}}), {{numbers(size)}}};
}

Specimen sizeByHand() {
  return {sharedCost(LandmarkSizeFactor{{}, {1, 1, 1}, {0.1, 0.2, 0.5}}), {{{1.1, 0.9, 1}}}, {1, -0.5, 0}};
}

// What geometry's projectShape says is the measurement; parts may be outside the image.
Specimen boxAtMeasurement(Random& random) {
  const ObjectShape shape = randomShape(random);
  const Eigen::Vector3d place = random.vector(3);
  const double yaw = random.uniform(-3, 3);
  const Pose3 world_from_object = poseFromYpr(place.x(), place.y(), place.z(), yaw, 0, 0);
  const Eigen::Vector3d center = world_from_object * Eigen::Vector3d(0, 0, shape.height / 2);
  const Pose3 world_from_camera = lookingAt(center + random.uniform(3, 5) * random.direction(),
                                            center + random.vector(1.5), random.uniform(-3, 3));
  LandmarkBoxFactor f;
  f.camera = testCamera();
  f.robot_from_camera = random.pose(0.5);
  f.box = projectShape(shape, world_from_camera.inverse() * world_from_object, f.camera).value().full;
  Specimen s{sharedCost(f, shape.kind), blocksOf(world_from_camera * f.robot_from_camera.inverse())};
  s.blocks.push_back({{place.x(), place.y(), place.z(), yaw}});
  s.blocks.push_back({sizeBlock(shape)});
  return s;
}

// The box covers x from 4 to 5 m, y within 1 m, z from 0 to 1 m; the camera is 1 m up. Its image: u = 320 -+
// 400 / 4, v from 240 (level with the camera) to 240 + 300 / 4. The measured right side is on the border.
Specimen boxByHand() {
  LandmarkBoxFactor f;
  f.camera = testCamera();
  f.robot_from_camera = forwardCamera();
  f.box = {210, 250, 640, 300};
  f.sigma_px = 5;
  Specimen s{sharedCost(f, ShapeKind::kCuboid), blocksOf(Pose3::Identity()), {2, -2, 0, 3}};
  s.blocks.push_back({{4.5, 0, 0, 0}});
  s.blocks.push_back({{2, 1, 1}});
  return s;
}

Specimen cameraPointAtMeasurement(Random& random) {
  const Pose3 pose = random.pose(3);
  CameraPointFactor f;
  f.camera = testCamera();
  f.robot_from_camera = random.pose(0.5);
  const Eigen::Vector3d seen(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(2, 5));
  f.pixel = f.camera.project(seen);
  if (random.index(2) == 0) f.depth_m = seen.z();
  Specimen s{sharedCost(f), blocksOf(pose)};
  s.blocks.push_back({numbers(pose * f.robot_from_camera * seen)});
  return s;
}

// The point is 4 m ahead, 1 m to the right, 0.5 m above the camera: u = 320 + 400 / 4, v = 240 - 300 / 8.
Specimen cameraPointByHand() {
  CameraPointFactor f;
  f.camera = testCamera();
  f.robot_from_camera = forwardCamera();
  f.pixel = {410, 205};
  f.sigma_px = 5;
  f.depth_m = 3.5;
  f.sigma_depth_m = 0.25;
  Specimen s{sharedCost(f), blocksOf(Pose3::Identity()), {2, -0.5, 2}};
  s.blocks.push_back({{4, -1, 1.5}});
  return s;
}

// Inside, but so near the surface that a push brings it out.
Specimen pointLandmarkAtMeasurement(Random& random) {
  const ObjectShape shape = randomShape(random);
  const Eigen::Vector3d place = random.vector(3);
  const double yaw = random.uniform(-3, 3), side = random.index(2) == 0 ? 0.49 : -0.49;
  const Eigen::Vector3d inside(side * shape.depth, 0.02 * shape.width, 0.98 * shape.height);
  Specimen s{sharedCost(PointLandmarkFactor{}, shape.kind),
             {{numbers(poseFromYpr(place.x(), place.y(), place.z(), yaw, 0, 0) * inside)}}};
  s.blocks.push_back({{place.x(), place.y(), place.z(), yaw}});
  s.blocks.push_back({sizeBlock(shape)});
  return s;
}

// In the object's frame the point is at (0.8, 1.4, 1.3); the object covers 0.5, 1 and 0 to 1: outside by
// (0.3, 0.4) in the plane and by 0.3 above.
Specimen pointLandmarkByHand() {
  PointLandmarkFactor f;
  f.sigma_horizontal_m = 0.1;
  f.sigma_vertical_m = 0.2;
  return {sharedCost(f, ShapeKind::kCuboid),
          {{{1 - 1.4, 2 + 0.8, 1.3}}, {{1, 2, 0, M_PI / 2}}, {{2, 1, 1}}},
          {5, 1.5}};
}

// On the front, the back, the left or the right of a cuboid.
Specimen sideAtMeasurement(Random& random) {
  ObjectShape shape = randomShape(random);
  shape.kind = ShapeKind::kCuboid;
  const Pose3 robot = random.pose(3);
  const Eigen::Vector3d place = random.vector(3);
  const double yaw = random.uniform(-3, 3), sign = random.index(2) == 0 ? 1 : -1;
  LandmarkSideFactor f;
  Eigen::Vector3d on_side(0.2 * shape.depth, 0.3 * shape.width, 0.3);
  if (random.index(2) == 0) {
    f.outward = sign * Eigen::Vector2d::UnitX();
    on_side.x() = sign * shape.depth / 2;
  } else {
    f.outward = sign * Eigen::Vector2d::UnitY();
    on_side.y() = sign * shape.width / 2;
  }
  f.point_in_robot = robot.inverse() * (poseFromYpr(place.x(), place.y(), place.z(), yaw, 0, 0) * on_side);
  Specimen s{sharedCost(f, shape.kind), blocksOf(robot)};
  s.blocks.push_back({{place.x(), place.y(), place.z(), yaw}});
  s.blocks.push_back({sizeBlock(shape)});
  return s;
}

// Robot at (1, 0), facing +y: the return 2 m ahead and .4 m to its right is at (1.4, 2). The sofa at (1, 3)
// faces -y: in its frame the return is 1 m to the front and .4 m to the left; its front is at .8 / 2.
Specimen sideByHand() {
  LandmarkSideFactor f;
  f.point_in_robot = {2, -0.4, 0.2};
  f.sigma_m = 0.1;
  Specimen s{sharedCost(f, ShapeKind::kCuboid), blocksOf(poseFromYpr(1, 0, 0, M_PI / 2, 0, 0)), {6}};
  s.blocks.push_back({{1, 3, 0, -M_PI / 2}});
  s.blocks.push_back({{1.8, 0.8, 0.9}});
  return s;
}

Specimen marginalPriorAtMeasurement(Random& random) {
  const Pose3 pose = random.pose(3);
  const LandmarkEstimate landmark{random.vector(3), random.uniform(-3, 3), randomShape(random)};
  const Eigen::Vector3d point = random.vector(3);
  MarginalPrior prior = priorOver(pose, landmark, point, 9);
  for (auto& value : prior.root.reshaped()) value = random.uniform(-2, 2);
  Specimen s{sharedCost(prior), blocksOf(pose)};
  s.blocks.push_back({{landmark.position.x(), landmark.position.y(), landmark.position.z(), landmark.yaw}});
  s.blocks.push_back({sizeBlock(landmark.shape)});
  s.blocks.push_back({numbers(point)});
  return s;
}

// x is 0.25 m further, weight 2, offset 0.5; turned about the world's z by 0.1 rad, weight 10; yaw of the
// landmark from 3 to -3 rad, 2 pi - 6 the short way, its height 0.25 m more, weight 4, the point 0.5 m lower,
// weight 3, offset -1.
Specimen marginalPriorByHand() {
  const Pose3 pose = poseFromYpr(1, 2, 3, 0.3, 0.2, 0.1);
  MarginalPrior prior = priorOver(pose, {{1, 1, 0}, 3, {ShapeKind::kCuboid, 1, 1, 1}}, {2, 2, 2}, 3);
  prior.root(0, 0) = 2;
  prior.root(1, 5) = 10;
  prior.root(2, 6 + 3) = 1;
  prior.root(2, 6 + 6) = 4;
  prior.root(2, 6 + 7 + 2) = 3;
  prior.offset << 0.5, 0, -1;
  Pose3 moved = pose;
  moved.translation().x() += 0.25;
  moved.linear() = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()).toRotationMatrix() * pose.linear();
  Specimen s{sharedCost(prior), blocksOf(moved), {1, 1, 2 * M_PI - 6 + 1 - 1.5 - 1}};
  s.blocks.push_back({{1, 1, 0, -3}});
  s.blocks.push_back({{1, 1, 1.25}});
  s.blocks.push_back({{2, 2, 1.5}});
  return s;
}

}  // namespace roomgraph::test
