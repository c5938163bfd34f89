// SPDX-License-Identifier: BSD-3-Clause
// Factors made of exact measurements of a shipped class: which ones, how many, with what weight, and without error.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "measurement_in_world.h"
#include "roomgraph/association/measurement_model.h"
#include "roomgraph/estimation/graph_builder.h"
#include "roomgraph/estimation/object_factors.h"
#include "shipped_objects.h"

namespace roomgraph::test {
namespace {

// Four key poses on an arc round a sofa of the usual size, and everything measured of it without error.
class SofaSeenFromFourPlaces : public ::testing::Test {
 protected:
  SofaSeenFromFourPlaces() : none_(MotionNoise{}, true), motion_{none_, none_, none_}, poses_(motion_) {
    sofa_.id = LandmarkId{7};
    sofa_.class_name = sofa_.model = "sofa";
    sofa_.shape = shippedObjects().find("sofa")->nominal();
    sofa_.position = {3, 0.5, 0};
    sofa_.yaw = 2.8;
    sofa_.has_yaw = true;
    robot_from_camera_ = poseFromYpr(0.1, 0.05, 1.2, 0, 0.15, 0);
    robot_from_camera_.linear() = robot_from_camera_.linear() * bodyFromOptical();
    for (int i = 0; i < 4; ++i) poses_.add(i, poseFromYpr(0.2 * i, -0.3 * i, 0, 0.15 * i, 0, 0));
    for (const auto& node : poses_.nodes()) frames_.push_back(seenAt(node.t, 0.9));
  }

  // Points 0 to 3 stand on the sofa's front; 0 is not in view of the last two key poses, 3 is not known to lie on it.
  ObjectFrame seenAt(double t, double score) const {
    ObjectFrame frame{.frame = FrameId{static_cast<std::int64_t>(10 * t)}, .t = t, .camera = camera_};
    frame.robot_from_camera = robot_from_camera_;
    const Pose3 world_from_camera = poses_.nearest(t).world_from_robot * robot_from_camera_;
    const Pose3 camera_from_object = world_from_camera.inverse() * sofa_.worldFromObject();
    ObjectDecision decision;
    decision.landmark = sofa_.id;
    decision.association.probability = 0.8;
    decision.seen.world_from_object = sofa_.worldFromObject();
    decision.seen.camera = camera_;
    auto& measurement = decision.seen.measurement;
    measurement.proposal.covariance = decision.seen.covariance = 0.01 * Eigen::Matrix4d::Identity();
    measurement.proposal.class_name = measurement.proposal.model = "sofa";
    measurement.proposal.shape = sofa_.shape;
    measurement.proposal.size_information = {100, 0, 100};
    measurement.proposal.camera_from_object = camera_from_object;
    measurement.proposal.has_yaw = true;
    measurement.proposal.score = score;
    measurement.confidence = 0.5;
    measurement.detection.box = projectShape(sofa_.shape, camera_from_object, camera_)->visible;
    measurement.features = {0, 1, 2, 8};
    for (int point = t > 1.5 ? 1 : 0; point < 4; ++point) {
      const Eigen::Vector3d p = camera_from_object * pointOnSofa(point);
      frame.features.push_back({camera_.project(p), point, p.z()});
    }
    frame.decisions = {decision};
    return frame;
  }
  Eigen::Vector3d pointOnSofa(int point) const {
    return {sofa_.shape.depth / 2, 0.3 * (point - 1), 0.2 + 0.1 * point};
  }

  MotionSource none_;
  Motion motion_;
  KeyPoses poses_;
  PinholeCamera camera_{640, 480, 520, 520, 319.5, 239.5, {}};
  Pose3 robot_from_camera_;
  Landmark sofa_;
  std::vector<ObjectFrame> frames_;
  BackendOptions options_;
};

TEST_F(SofaSeenFromFourPlaces, GivesEveryKindOfFactorItsNumber) {
  const ObjectFactors factors = objectFactors(frames_, poses_, {sofa_}, shippedObjects(), options_);
  EXPECT_EQ(factors.sightings.size(), factors.views.size()) << "no direction twice";
  EXPECT_EQ(factors.shared_errors.size(), factors.views.size());
  ASSERT_EQ(factors.boxes.size(), 4u) << "one of each key pose";
  ASSERT_EQ(factors.sizes.size(), factors.views.size() + 2) << "and the least and the usual size, once";
  const ObjectModel& usual = *shippedObjects().find("sofa");
  for (const auto& size : factors.sizes) EXPECT_EQ(size.landmark, sofa_.id);
  EXPECT_EQ(factors.sizes.back().sigma_m.x(), usual.width_sigma_m);
  EXPECT_EQ(factors.sizes.back().size_m.x(), usual.width_m);
  for (std::size_t i = 0; i < factors.views.size(); ++i) {
    // 1 / (.1 m)^2 in each sighting, each with this weight.
    EXPECT_NEAR(factors.sizes[i].sigma_m.x(), 0.1 / std::sqrt(0.8 * 0.5 * 0.9), 0.01);
    EXPECT_GT(factors.sizes[i].sigma_m.y(), 100) << "the depth was not seen";
    EXPECT_NEAR(factors.sizes[i].size_m.z(), sofa_.shape.height, 1e-9);
  }
  std::vector<std::int64_t> points;
  for (const auto& [id, place] : factors.points) {
    points.push_back(id.value);
    const Eigen::Vector3d truth = sofa_.worldFromObject() * pointOnSofa(static_cast<int>(id.value));
    EXPECT_LT((place - truth).norm(), 1e-9);
  }
  EXPECT_EQ(points, (std::vector<std::int64_t>{1, 2})) << "point 0 was seen from two key poses, 3 is not on it";
  EXPECT_EQ(factors.point_views.size(), 8u);
  ASSERT_EQ(factors.insides.size(), 2u);
  const double weight = 0.8 * 0.5 * 0.9, of_two = 1 / (1 + options_.landmark_repeating_share);
  // Key poses 1 and 2 see the sofa from directions .28 and .40 rad, which are one step of .26 rad.
  const std::set<NodeId> together = {NodeId{1}, NodeId{2}};
  for (const auto& box : factors.boxes)
    EXPECT_NEAR(box.weight, together.contains(box.node) ? weight * of_two : weight, 1e-12) << box.node.value;
  for (const auto& sighting : factors.sightings) EXPECT_NEAR(sighting.weight, weight, 1e-12);
  for (const auto& inside : factors.insides) EXPECT_NEAR(inside.weight, of_two, 1e-12);
}

TEST_F(SofaSeenFromFourPlaces, LeavesNoErrorWhereEverythingIsTrue) {
  const ObjectFactors factors = objectFactors(frames_, poses_, {sofa_}, shippedObjects(), options_);
  FactorGraph graph;
  for (const auto& node : poses_.nodes()) graph.addPose(node.id, node.world_from_robot);
  graph.addLandmark(sofa_.id, {sofa_.position, sofa_.yaw, sofa_.shape});
  for (const auto& [id, view] : factors.views) graph.addLandmark(id, view);
  for (const auto& [id, place] : factors.points) graph.addPoint(id, place);
  const auto add = [&](const auto& list) {
    for (const auto& factor : list) graph.add(factor);
  };
  add(factors.sightings), add(factors.shared_errors), add(factors.boxes), add(factors.sizes);
  add(factors.point_views), add(factors.insides);
  EXPECT_EQ(graph.factors(), 3 * factors.views.size() + 2u + 4u + 8u + 2u);
  EXPECT_LT(graph.chiSquared(), 1e-12);
}

TEST_F(SofaSeenFromFourPlaces, AllOfThemReachTheGraph) {
  const ObjectFactors factors = objectFactors(frames_, poses_, {sofa_}, shippedObjects(), options_);
  const FactorGraph without = buildGraph(poses_, motion_, {}, {}, options_);
  const FactorGraph with = buildGraph(poses_, motion_, {}, {{sofa_}, factors}, options_);
  EXPECT_EQ(with.factors() - without.factors(), 3 * factors.views.size() + 2u + 4u + 8u + 2u + 1u)
      << "and the one that stands it on the floor";
  EXPECT_EQ(with.landmarks(), 1 + factors.views.size());
}

LandmarkBoxFactor boxOf(const ObjectFactors& factors, int node) {
  for (const auto& box : factors.boxes)
    if (box.node.value == node) return box;
  return {};
}

TEST_F(SofaSeenFromFourPlaces, TheBestBoxOfAKeyPoseCounts) {
  ObjectFrame better = seenAt(2, 0.95), worse = seenAt(2, 0.1);
  const double right = better.decisions[0].seen.measurement.detection.box.u_max;
  better.decisions[0].seen.measurement.detection.box.u_max = right - 1;
  worse.decisions[0].seen.measurement.detection.box.u_max = right - 2;
  for (auto* more : {&better, &worse}) more->t = 2.1;
  frames_.push_back(better);
  frames_.push_back(worse);
  const ObjectFactors factors = objectFactors(frames_, poses_, {sofa_}, shippedObjects(), options_);
  ASSERT_EQ(factors.boxes.size(), 4u);
  EXPECT_EQ(boxOf(factors, 2).box.u_max, right - 1);
}

// The leaf of an open door has another box than its doorway; what shows above a table has less than the
// object.
TEST_F(SofaSeenFromFourPlaces, ABoxThatItsOwnShapeDoesNotExplainIsNone) {
  Box2& box = frames_[3].decisions[0].seen.measurement.detection.box;
  box.v_max = box.v_min + 0.6 * box.height();
  const ObjectFactors factors = objectFactors(frames_, poses_, {sofa_}, shippedObjects(), options_);
  EXPECT_EQ(factors.boxes.size(), 3u);
  EXPECT_FALSE(boxOf(factors, 3).landmark.valid());
}

TEST_F(SofaSeenFromFourPlaces, ASideOfABoxIsAsSureAsItsSize) {
  options_.box_sigma = 0.1;
  const LandmarkBoxFactor box = boxOf(objectFactors(frames_, poses_, {sofa_}, shippedObjects(), options_), 0);
  EXPECT_NEAR(box.sigma_px, std::hypot(2, 0.1 * (box.box.width() + box.box.height()) / 2), 1e-9);
}

TEST_F(SofaSeenFromFourPlaces, OptionsBoundWhatIsMade) {
  options_.points_per_landmark = 1;
  EXPECT_EQ(objectFactors(frames_, poses_, {sofa_}, shippedObjects(), options_).points.size(), 1u);
  options_.object_boxes = false;
  const ObjectFactors factors = objectFactors(frames_, poses_, {sofa_}, shippedObjects(), options_);
  EXPECT_TRUE(factors.boxes.empty());
  EXPECT_FALSE(factors.sizes.empty()) << "they are measured by shapes, not by boxes";
}

TEST_F(SofaSeenFromFourPlaces, AnotherLabelSaysNothingOfThePlace) {
  for (auto& frame : frames_) frame.decisions[0].seen.measurement.proposal.class_name = "swivel_chair";
  const ObjectFactors factors = objectFactors(frames_, poses_, {sofa_}, shippedObjects(), options_);
  EXPECT_TRUE(factors.sightings.empty());
  EXPECT_TRUE(factors.boxes.empty());
}

// A place 1.5 m behind the sofa on the ray, with a score of 0.1: its depth is rather that of something else.
TEST_F(SofaSeenFromFourPlaces, AFailedDepthCountsLittle) {
  const MeasurementModel model;
  auto& seen = frames_[0].decisions[0].seen;
  seen.measurement.proposal.score = 0.1;
  seen.measurement.proposal.camera_from_object.translation() *= 1.5;
  const auto weightOf = [&](const MeasurementModel* trusted) {
    return objectFactors(frames_, poses_, {sofa_}, shippedObjects(), options_, trusted).sightings[0].weight;
  };
  const Pose3 world_from_camera = poses_.nodes()[0].world_from_robot * robot_from_camera_;
  const double trust = model.depthTrust(measurementInWorld(seen.measurement, seen.camera, world_from_camera, options_.pose_sigma_m), sofa_);
  EXPECT_LT(trust, 0.5);
  EXPECT_GT(trust, 0);
  EXPECT_NEAR(weightOf(&model), trust * weightOf(nullptr), 1e-12);
  EXPECT_GT(weightOf(nullptr), 0);
}

// Whether a depth failed is asked where the poses of now place the sighting: the path may have moved since it was decided.
TEST_F(SofaSeenFromFourPlaces, ADepthIsTrustedByThePosesOfNow) {
  const MeasurementModel model;
  const auto weightsOf = [&](const MeasurementModel* trusted) {
    std::vector<double> out;
    for (const auto& sighting : objectFactors(frames_, poses_, {sofa_}, shippedObjects(), options_, trusted).sightings) out.push_back(sighting.weight);
    return out;
  };
  const auto before = weightsOf(&model), whole = weightsOf(nullptr);
  for (auto& frame : frames_) frame.decisions[0].seen.world_from_object.pretranslate(Eigen::Vector3d(1, -1, 0));
  EXPECT_EQ(weightsOf(&model), before);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_GT(before[i], 0.9 * whole[i]);
}

// A closure in the plane knows nothing of height, roll and pitch, whatever its covariance says of them.
TEST(ClosureFactor, InThePlaneLeavesHeightAndTiltFree) {
  const MotionSource none(MotionNoise{}, true);
  const Motion motion{none, none, none};
  KeyPoses poses(motion);
  poses.add(0, Pose3::Identity());
  poses.add(1, poseFromYpr(1, 0, 0.5, 0, 0.3, 0));
  const auto chiSquared = [&](bool planar) {
    RelativePose closure;
    closure.t_b = 1;
    closure.a_from_b = poseFromYpr(1, 0, 0, 0, 0, 0);
    closure.covariance = 1e-6 * Matrix6d::Identity();
    closure.planar = planar;
    BackendOptions options;
    options.closure_robust_width = 0;
    const Measurements without{.planar = false}, with{{closure}, {}, false};
    return buildGraph(poses, motion, with, {}, options).chiSquared() -
           buildGraph(poses, motion, without, {}, options).chiSquared();
  };
  // 0.5 m and twice the sine of half of 0.3 rad, each against a standard deviation of 0.5.
  EXPECT_NEAR(chiSquared(true), (0.5 * 0.5 + std::pow(2 * std::sin(0.15), 2)) / 0.25, 1e-6);
  EXPECT_GT(chiSquared(false), 1e4);
}

// A robot that heads along world y, and a camera on it that looks to its left: the error along the line of
// sight is one to the robot's side. The pose's own uncertainty, in the covariance in world, is not the
// sighting's.
TEST(SightingCovariance, IsInTheRobotsFrame) {
  const KeyPose node{NodeId{0}, 0, poseFromYpr(1, 1, 0, M_PI / 2, 0, 0)};
  ObjectDecision decision;
  decision.seen.covariance = 7 * Eigen::Matrix4d::Identity();
  auto& covariance = decision.seen.measurement.proposal.covariance;
  covariance = Eigen::Vector4d(0.09, 0.01, 0.0004, 0.2).asDiagonal();
  covariance(0, 1) = covariance(1, 0) = 0.02;
  Pose3 robot_from_camera = poseFromYpr(0.1, 0, 1, M_PI / 2, 0, 0);
  robot_from_camera.linear() = robot_from_camera.linear() * bodyFromOptical();
  const auto factor = sightingOf(decision, LandmarkId{1}, node, robot_from_camera);
  EXPECT_NEAR(factor.covariance(0, 0), 0.01, 1e-12);
  EXPECT_NEAR(factor.covariance(1, 1), 0.09, 1e-12);
  EXPECT_NEAR(factor.covariance(0, 1), -0.02, 1e-12);
  EXPECT_NEAR(factor.covariance(3, 3), 0.2, 1e-12);
}

}  // namespace
}  // namespace roomgraph::test
