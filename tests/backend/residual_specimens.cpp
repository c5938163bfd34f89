// SPDX-License-Identifier: BSD-3-Clause
// Exact and hand-computed states of the residuals of poses and landmarks.
#include "residual_specimens.h"

#include "object_specimens.h"

namespace roomgraph::test {
namespace {

Specimen betweenAtMeasurement(Random& random) {
  const Pose3 a = random.pose(3), a_from_b = random.pose(1, 1.5);
  Specimen s{sharedCost(BetweenFactor{{}, {}, a_from_b, randomCovariance<6>(random)}), blocksOf(a)};
  append(s.blocks, a * a_from_b);
  return s;
}

// a at (1, 2, 0) heading +y; b one metre ahead of it, but measured 1.2 m ahead, and turned by a further 0.2
// rad about z that the measurement does not have. Sigmas 0.1 m and 0.05 rad; rotation error 2 sin(0.1) rad.
Specimen betweenByHand() {
  BetweenFactor f;
  f.a_from_b = poseFromYpr(1.2, 0, 0, 0, 0, 0);
  f.covariance = Matrix6d::Identity() * 0.01;
  f.covariance.bottomRightCorner<3, 3>() *= 0.25;
  Specimen s{sharedCost(f),
             blocksOf(poseFromYpr(1, 2, 0, M_PI / 2, 0, 0)),
             {-2, 0, 0, 0, 0, 2 * std::sin(0.1) / 0.05}};
  append(s.blocks, poseFromYpr(1, 3, 0, M_PI / 2 + 0.2, 0, 0));
  return s;
}

Specimen planarAtMeasurement(Random& random) {
  const Pose2 pose{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-3, 3)};
  return {sharedCost(PlanarFactor{{}, 0.02, 0.03}), blocksOf(toPose3(pose))};
}

// 4 cm too high with a sigma of 2 cm; nose 0.1 rad down: the up axis leans forward by sin(0.1), heading +y.
Specimen planarByHand() {
  return {sharedCost(PlanarFactor{{}, 0.02, 0.05}),
          blocksOf(poseFromYpr(7, 8, 0.04, M_PI / 2, 0.1, 0)),
          {2, 0, std::sin(0.1) / 0.05}};
}

Specimen groundAtMeasurement(Random& random) {
  const Pose3 pose = random.pose(2, 1);
  GroundFactor f;
  f.normal_in_robot = 2 * (pose.linear().transpose() * Eigen::Vector3d::UnitZ());  // any length will do
  f.offset_m = pose.translation().z();
  return {sharedCost(f), blocksOf(pose)};
}

// An upright sensor 1.5 m up says 1.4 m, and sees a floor whose normal leans forward by atan(3/4).
Specimen groundByHand() {
  return {sharedCost(GroundFactor{{}, {0.6, 0, 0.8}, 1.4, 0.2, 0.05}),
          blocksOf(poseFromYpr(3, 1, 1.5, 0, 0, 0)),
          {3, 0, 2}};
}

LandmarkFactor exactSighting(const Pose3& pose, const std::vector<double>& object) {
  LandmarkFactor f;
  f.position_in_robot = pose.inverse() * Eigen::Vector3d(object[0], object[1], object[2]);
  f.yaw_in_robot = wrapAngle(object[3] - planarPart(pose).yaw);
  return f;
}

Specimen sightingAtMeasurement(Random& random) {
  const Pose3 pose = random.pose(2, 1);
  const Eigen::Vector3d p = random.vector(3);
  const std::vector<double> object{p.x(), p.y(), p.z(), random.uniform(-3, 3)};
  LandmarkFactor f = exactSighting(pose, object);
  f.has_yaw = random.index(2) == 0;
  f.covariance = randomCovariance<4>(random);
  f.weight = random.uniform(0.2, 1);
  Specimen s{sharedCost(f), blocksOf(pose)};
  s.blocks.push_back({object});
  return s;
}

// Robot at (1, 1) heading +y. The object at (1, 3, 0) is 2 m ahead of it, measured 1.8 m ahead and 0.1 m to
// the left; its yaw of -3.0 rad against a measured 1.6 rad: -3 - pi/2 - 1.6 = -6.1708 rad, wrapped + 2 pi.
// The weight belongs to the loss and leaves the residual alone; sigmas 0.1 m and 0.1 rad.
Specimen sightingByHand() {
  LandmarkFactor f;
  f.position_in_robot = {1.8, 0.1, 0};
  f.yaw_in_robot = 1.6;
  f.has_yaw = true;
  f.covariance = Eigen::Matrix4d::Identity() * 0.01;
  f.weight = 0.25;
  Specimen s{
      sharedCost(f), blocksOf(poseFromYpr(1, 1, 0, M_PI / 2, 0, 0)), {2, -1, 0, (1.5 * M_PI - 4.6) / 0.1}};
  s.blocks.push_back({{1, 3, 0, -3}});
  return s;
}

Specimen viewAtMeasurement(Random& random) {
  const Eigen::Vector3d p = random.vector(3);
  const std::vector<double> object{p.x(), p.y(), p.z(), random.uniform(-3, 3)};
  LandmarkViewFactor f;
  f.has_yaw = random.index(2) == 0;
  f.covariance = randomCovariance<4>(random);
  f.offset_by_size << random.uniform(-0.5, 0.5), 0, 0.1, 0.2, random.uniform(-0.5, 0.5), 0;
  const Eigen::Vector3d size(1.8, 0.9, 0.8);
  f.offset_m = -f.offset_by_size * size;  // it was taken for what it is
  return {sharedCost(f), {{object}, {object}, {{size.x(), size.y(), size.z()}}}};
}

// The view stands 0.2 m east and 0.1 m south of the landmark and is turned by 3 - (-3) rad, which is 6 - 2
// pi; its fits of 1.6 m width are .2 m too narrow, so that their middles are .1 m ahead of the landmark's;
// sigmas 0.1 m and 0.1 rad.
Specimen viewByHand() {
  LandmarkViewFactor f;
  f.has_yaw = true;
  f.covariance = Eigen::Matrix4d::Identity() * 0.01;
  f.offset_by_size(0, 0) = 0.5;
  f.offset_m.x() = -0.5 * 1.6;
  return {sharedCost(f),
          {{{1.2, 1.9, 0, 3}}, {{1, 2, 0, -3}}, {{1.8, 0.9, 0.8}}},
          {2 - std::cos(3), -1 + std::sin(3), 0, (6 - 2 * M_PI) / 0.1}};
}

Specimen onFloorAtMeasurement(Random& random) {
  return {sharedCost(LandmarkGroundFactor{{}, 0.02}),
          {{{random.uniform(-3, 3), random.uniform(-3, 3), 0, random.uniform(-3, 3)}}}};
}

Specimen onFloorByHand() {
  return {sharedCost(LandmarkGroundFactor{{}, 0.02}), {{{1, 2, -0.05, 1}}}, {-2.5}};
}

Specimen planarEdgeAtMeasurement(Random& random) {
  const Pose2 a{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-3, 3)};
  const Pose2 a_from_b{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3)};
  const Pose2 b = a * a_from_b;
  return {sharedCost(PlanarEdge{{}, {}, a_from_b, randomCovariance<3>(random)}),
          {{{a.x, a.y, a.yaw}}, {{b.x, b.y, b.yaw}}}};
}

// a at (1, 2) heading +y, b one metre ahead, measured 1.2 m ahead and turned left by 90 degrees: the error of
// -0.2 m along a's x is +0.2 m along the measured b's y. b's yaw is 0.2 rad more than measured, given 2 pi
// less. Weights 2, 5, 10.
Specimen planarEdgeByHand() {
  const Eigen::Vector3d information(4, 25, 100);
  return {sharedCost(PlanarEdge{{}, {}, {1.2, 0, M_PI / 2}, information.asDiagonal()}),
          {{{1, 2, M_PI / 2}}, {{1, 3, 0.2 - M_PI}}},
          {0, 1, 2}};
}

template <Specimen (*kAtMeasurement)(Random&), Specimen (*kByHand)()>
struct Known {
  static Specimen atMeasurement(Random& random) { return kAtMeasurement(random); }
  static Specimen byHand() { return kByHand(); }
};

}  // namespace

template <>
struct SpecimenOf<BetweenFactor> : Known<betweenAtMeasurement, betweenByHand> {
  static constexpr auto kName = "BetweenFactor";
};
template <>
struct SpecimenOf<PlanarFactor> : Known<planarAtMeasurement, planarByHand> {
  static constexpr auto kName = "PlanarFactor";
};
template <>
struct SpecimenOf<GroundFactor> : Known<groundAtMeasurement, groundByHand> {
  static constexpr auto kName = "GroundFactor";
};
template <>
struct SpecimenOf<LandmarkFactor> : Known<sightingAtMeasurement, sightingByHand> {
  static constexpr auto kName = "LandmarkFactor";
};
template <>
struct SpecimenOf<LandmarkViewFactor> : Known<viewAtMeasurement, viewByHand> {
  static constexpr auto kName = "LandmarkViewFactor";
};
template <>
struct SpecimenOf<LandmarkGroundFactor> : Known<onFloorAtMeasurement, onFloorByHand> {
  static constexpr auto kName = "LandmarkGroundFactor";
};
template <>
struct SpecimenOf<LandmarkSizeFactor> : Known<sizeAtMeasurement, sizeByHand> {
  static constexpr auto kName = "LandmarkSizeFactor";
};
template <>
struct SpecimenOf<LandmarkBoxFactor> : Known<boxAtMeasurement, boxByHand> {
  static constexpr auto kName = "LandmarkBoxFactor";
};
template <>
struct SpecimenOf<CameraPointFactor> : Known<cameraPointAtMeasurement, cameraPointByHand> {
  static constexpr auto kName = "CameraPointFactor";
};
template <>
struct SpecimenOf<PointLandmarkFactor> : Known<pointLandmarkAtMeasurement, pointLandmarkByHand> {
  static constexpr auto kName = "PointLandmarkFactor";
};
template <>
struct SpecimenOf<LandmarkSideFactor> : Known<sideAtMeasurement, sideByHand> {
  static constexpr auto kName = "LandmarkSideFactor";
};
template <>
struct SpecimenOf<MarginalPrior> : Known<marginalPriorAtMeasurement, marginalPriorByHand> {
  static constexpr auto kName = "MarginalPrior";
};
template <>
struct SpecimenOf<PlanarEdge> : Known<planarEdgeAtMeasurement, planarEdgeByHand> {
  static constexpr auto kName = "PlanarEdge";
};

namespace {

template <class... Measurements>
std::vector<ResidualCase> casesOf(std::type_identity<std::variant<Measurements...>>) {
  return {{SpecimenOf<Measurements>::kName, SpecimenOf<Measurements>::atMeasurement,
           SpecimenOf<Measurements>::byHand}...};
}

}  // namespace

std::vector<ResidualCase> residualCases() {
  auto cases = casesOf(std::type_identity<Factor>{});
  for (const auto& planar : casesOf(std::type_identity<std::variant<PlanarEdge>>{})) cases.push_back(planar);
  return cases;
}

}  // namespace roomgraph::test
