// SPDX-License-Identifier: BSD-3-Clause
// Object factors: residual-free sightings, means, visits and views; split of landmarks by time.
#include "roomgraph/estimation/object_factors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "random_poses.h"
#include "roomgraph/estimation/object_loop_closer.h"
#include "roomgraph/geometry/projection.h"
#include "shipped_objects.h"

namespace roomgraph::test {
namespace {

// A sighting of a landmark must leave no residual when poses and landmark are the true ones.
TEST(Sighting, AgreesWithThePosesItWasMadeFrom) {
  Random random(4);
  for (int i = 0; i < 30; ++i) {
    Landmark landmark;
    landmark.id = LandmarkId{3};
    landmark.position = {random.uniform(-5, 5), random.uniform(-5, 5), 0};
    landmark.yaw = random.uniform(-3, 3);
    const KeyPose node{
        NodeId{7}, 1,
        poseFromYpr(random.uniform(-5, 5), random.uniform(-5, 5), 0, random.uniform(-3, 3), 0, 0)};
    const Pose3 node_from_camera = random.pose(0.5);
    ObjectDecision decision;
    decision.seen.measurement.proposal.has_yaw = true;
    decision.seen.measurement.proposal.score = 0.5;
    decision.seen.measurement.confidence = 0.8;
    decision.association.probability = 0.9;
    decision.seen.measurement.proposal.camera_from_object =
        (node.world_from_robot * node_from_camera).inverse() * landmark.worldFromObject();
    const LandmarkFactor factor = sightingOf(decision, landmark.id, node, node_from_camera);
    EXPECT_EQ(factor.node.value, 7);
    EXPECT_EQ(factor.landmark.value, 3);
    EXPECT_LT((node.world_from_robot * factor.position_in_robot - landmark.position).norm(), 1e-9);
    EXPECT_NEAR(wrapAngle(planarPart(node.world_from_robot).yaw + factor.yaw_in_robot - landmark.yaw), 0,
                1e-9);
    EXPECT_NEAR(factor.weight, 0.9 * 0.8 * 0.5, 1e-12);
  }
}

LandmarkFactor factorAt(double x, double yaw, double weight, double sigma_m, bool has_yaw = true) {
  LandmarkFactor factor;
  factor.position_in_robot = {x, 0, 0};
  factor.yaw_in_robot = yaw;
  factor.has_yaw = has_yaw;
  factor.weight = weight;
  factor.covariance = sigma_m * sigma_m * Eigen::Matrix4d::Identity();
  return factor;
}

// A sure place with an unsure yaw, and the other way round.
TEST(Sighting, YawsAreWeighedByTheirOwnVariance) {
  LandmarkFactor place = factorAt(1, 1.0, 1, 0.01), yaw = factorAt(2, 0.0, 1, 0.1);
  place.covariance(3, 3) = 0.09;
  yaw.covariance(3, 3) = 0.01;
  const auto mean = meanSighting({place, yaw}, 1e6);
  EXPECT_LT(mean.position_in_robot.x(), 1.02);
  EXPECT_NEAR(mean.yaw_in_robot, std::atan2(std::sin(1.0), 9 + std::cos(1.0)), 1e-12);
  EXPECT_NEAR(mean.covariance(3, 3), 2 / (1 / 0.09 + 1 / 0.01), 1e-12);
}

TEST(Sighting, MeanWeighsByScoreAndPrecisionButIsNoSurerThanOne) {
  const auto mean = meanSighting({factorAt(1, 3.1, 0.8, 0.1), factorAt(2, -3.1, 0.4, 0.2)}, 1e6);
  // Shares .8 / .01 and .4 / .04 stand 8 to 1.
  EXPECT_NEAR(mean.position_in_robot.x(), 1 + 1.0 / 9, 1e-9);
  EXPECT_NEAR(mean.covariance(0, 0), (8 * 0.01 + 0.04) / 9, 1e-9);
  EXPECT_EQ(mean.weight, 0.8);
  EXPECT_NEAR(std::abs(wrapAngle(mean.yaw_in_robot - 3.1)), 2 * (M_PI - 3.1) / 9, 1e-3)
      << "the short way round";
  EXPECT_FALSE(meanSighting({factorAt(1, 0, 1, 0.1, false)}, 1).has_yaw);
}

// The place of least weighted Cauchy losses, by trying all.
double bruteForceMean(const std::vector<LandmarkFactor>& sightings, double robust_width) {
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (double x = -1; x < 6; x += 1e-4) {
    double loss = 0;
    for (const auto& s : sightings)
      loss += s.weight *
              std::log1p(std::pow((x - s.position_in_robot.x()) / robust_width, 2) / s.covariance(0, 0));
    if (loss < least) least = loss, best = x;
  }
  return best;
}

TEST(Sighting, MeanIsNotDrawnAwayByThoseWhoseDepthFailed) {
  const std::vector<LandmarkFactor> sightings{
      factorAt(2.6, 0, 0.7, 0.1), factorAt(2.64, 0, 0.7, 0.1),  factorAt(3.43, 0, 0.5, 0.1),
      factorAt(3.4, 0, 0.5, 0.1), factorAt(3.41, 0, 0.5, 0.15), factorAt(3.3, 0, 0.6, 0.1)};
  for (const double width : {0.5, 1.0, 2.0}) {
    const auto mean = meanSighting(sightings, width);
    EXPECT_NEAR(mean.position_in_robot.x(), bruteForceMean(sightings, width), 1e-3) << width;
    EXPECT_GT(mean.position_in_robot.x(), 3.3) << width;
    // In another order the sums have other last bits.
    EXPECT_NEAR(meanSighting({sightings.rbegin(), sightings.rend()}, width).position_in_robot.x(),
                mean.position_in_robot.x(), 1e-3);
  }
  EXPECT_NEAR(meanSighting({factorAt(1, 0, 0.2, 0.1), factorAt(3, 0, 0.6, 0.1)}, 1).position_in_robot.x(), 3,
              0.02)
      << "of two that disagree the better one";
}

const Eigen::Vector3d kChair(3, 1, 0);

// Key poses on a short way towards the chair, twice, and one behind it in between.
KeyPoses twoVisits(const Motion& motion) {
  KeyPoses poses(motion);
  for (int i = 0; i < 3; ++i) poses.add(i, poseFromYpr(0.3 * i, 0, 0, 0.2, 0, 0));
  poses.add(50, poseFromYpr(5, 2, 0, -2, 0, 0));
  for (int i = 0; i < 3; ++i) poses.add(100 + i, poseFromYpr(0.3 * i, 0.1, 0, 0.1, 0, 0));
  return poses;
}

Landmark chair() {
  Landmark out;
  out.id = LandmarkId{4};
  out.class_name = "swivel_chair";
  out.position = kChair;
  return out;
}

// The chair as every key pose sees it: from the front 0.1 m too far along x, from behind too near.
std::vector<ObjectFrame> framesOf(const KeyPoses& poses) {
  std::vector<ObjectFrame> frames;
  for (const auto& node : poses.nodes()) {
    const double error = node.t == 50 ? -0.1 : 0.1;
    ObjectDecision decision;
    decision.landmark = LandmarkId{4};
    decision.association.probability = 0.8;
    auto& measurement = decision.seen.measurement;
    measurement.proposal.covariance = 0.01 * Eigen::Matrix4d::Identity();
    measurement.confidence = measurement.proposal.score = 1;
    measurement.proposal.class_name = "swivel_chair";
    measurement.proposal.camera_from_object =
        node.world_from_robot.inverse() * poseFromYpr(kChair.x() + error, kChair.y(), 0, 0, 0, 0);
    frames.push_back({.frame = {}, .t = node.t, .camera = {}, .decisions = {decision}, .features = {}});
  }
  return frames;
}

// The variance of (.2 x .1 m)^2 is divided between what both visits to the front share and what each has for itself.
TEST(ObjectFactors, AVisitCountsOnceAndSharesTheErrorOfItsDirection) {
  const MotionSource none(MotionNoise{}, true);
  const Motion motion{none, none, none};
  const KeyPoses poses = twoVisits(motion);
  BackendOptions options;
  options.landmark_sigma_share = 0.2;
  options.landmark_repeating_share = 0.7;
  const ObjectFactors factors = objectFactors(framesOf(poses), poses, {chair()}, {}, options);
  ASSERT_EQ(factors.views.size(), 2u) << "from the front, and from behind";
  ASSERT_EQ(factors.shared_errors.size(), 2u);
  for (const auto& shared : factors.shared_errors) {
    EXPECT_EQ(shared.landmark, LandmarkId{4});
    EXPECT_TRUE(factors.views.contains(shared.view));
    EXPECT_NEAR(shared.weight, 0.8, 1e-12);
    EXPECT_TRUE(shared.covariance.isApprox(0.04 * 0.007 * Eigen::Matrix4d::Identity(), 1e-9));
  }
  std::map<LandmarkId, std::vector<std::int64_t>> nodes;
  for (const auto& sighting : factors.sightings) {
    nodes[sighting.landmark].push_back(sighting.node.value);
    const Pose3& pose = poses.node(sighting.node).world_from_robot;
    const double error = sighting.node.value == 3 ? -0.1 : 0.1;
    EXPECT_LT((pose * sighting.position_in_robot - kChair - error * Eigen::Vector3d::UnitX()).norm(), 1e-9);
    EXPECT_NEAR(sighting.weight, 0.8, 1e-12);
    EXPECT_TRUE(sighting.covariance.isApprox(0.04 * 0.003 * Eigen::Matrix4d::Identity(), 1e-9));
  }
  std::set<std::vector<std::int64_t>> by_view;
  for (const auto& [view, seen_from] : nodes) by_view.insert(seen_from);
  EXPECT_EQ(by_view, (std::set<std::vector<std::int64_t>>{{1, 5}, {3}})) << "the middle of each visit";
}

// A graph that is built again goes on from its views: who comes first among the landmarks must not name them.
TEST(ObjectFactors, AViewKeepsItsIdWhateverElseIsSeen) {
  const MotionSource none(MotionNoise{}, true);
  const Motion motion{none, none, none};
  const KeyPoses poses = twoVisits(motion);
  std::vector<ObjectFrame> frames = framesOf(poses);
  const ObjectFactors alone = objectFactors(frames, poses, {chair()}, {}, {});
  Landmark other = chair();
  other.id = LandmarkId{3};
  for (ObjectFrame& frame : frames) {
    frame.decisions.push_back(frame.decisions.front());
    frame.decisions.back().landmark = other.id;
  }
  const ObjectFactors both = objectFactors(frames, poses, {other, chair()}, {}, {});
  EXPECT_EQ(both.views.size(), 2 * alone.views.size());
  for (const auto& shared : alone.shared_errors) {
    const auto same = std::find_if(both.shared_errors.begin(), both.shared_errors.end(),
                                   [&](const LandmarkViewFactor& f) { return f.view == shared.view; });
    ASSERT_NE(same, both.shared_errors.end());
    EXPECT_EQ(same->landmark, LandmarkId{4});
  }
}

// Two directions whose errors cancel: the landmark is in the middle, and its variance is that of two independent
// errors, however often each was looked at.
TEST(ObjectFactors, ViewsAreAveragedNotSightings) {
  const MotionSource none(MotionNoise{}, true);
  const Motion motion{none, none, none};
  const KeyPoses poses = twoVisits(motion);
  BackendOptions options;
  options.landmark_sigma_share = 1;
  options.landmark_repeating_share = 0.999;
  options.landmark_robust_width = 0;
  const ObjectFactors factors = objectFactors(framesOf(poses), poses, {chair()}, {}, options);
  FactorGraph graph;
  for (const auto& node : poses.nodes()) graph.addPose(node.id, node.world_from_robot, true);
  graph.addLandmark(LandmarkId{4}, {kChair + Eigen::Vector3d(0.3, 0, 0), 0, {}});
  for (const auto& [id, view] : factors.views) graph.addLandmark(id, view);
  for (const auto& factor : factors.shared_errors) graph.add(factor);
  for (const auto& factor : factors.sightings) graph.add(factor);
  ASSERT_TRUE(graph.optimize().usable);
  EXPECT_LT((graph.landmark(LandmarkId{4}).position - kChair).norm(), 1e-4);
  const double variance = graph.landmarkCovariances().value().at(LandmarkId{4})(0, 0);
  EXPECT_NEAR(variance, 0.01 / 0.8 / 2, 1e-4);
}

// The same with a yaw: two of the seven sightings took width for depth, one the back for the front.
constexpr double kTrueYaw = 0.4, kWrongYaw = 2.0;
bool isTurned(std::size_t sighting) {
  return sighting == 1 || sighting == 5;
}
std::vector<ObjectFrame> framesWithYaws(const KeyPoses& poses) {
  auto frames = framesOf(poses);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    auto& proposal = frames[i].decisions[0].seen.measurement.proposal;
    const double yaw = isTurned(i) ? kWrongYaw : i == 2 ? kTrueYaw - M_PI : kTrueYaw;
    proposal.camera_from_object =
        poses.nodes()[i].world_from_robot.inverse() * poseFromYpr(3, 1, 0, yaw, 0, 0);
    proposal.has_yaw = true;
  }
  return frames;
}

// Five of seven sightings agree on the yaw; the two that took width for depth claim to be far surer. The
// landmark itself has the wrong yaw so far.
TEST(ObjectFactors, TheYawIsThatOfMostSightingsNotOfTheSurest) {
  const MotionSource none(MotionNoise{}, true);
  const Motion motion{none, none, none};
  const KeyPoses poses = twoVisits(motion);
  auto frames = framesWithYaws(poses);
  for (std::size_t i = 0; i < frames.size(); ++i)
    frames[i].decisions[0].seen.measurement.proposal.covariance(3, 3) = isTurned(i) ? 0.001 : 0.1;
  Landmark landmark = chair();
  landmark.yaw = kWrongYaw;
  landmark.has_yaw = true;
  const BackendOptions options;
  const ObjectFactors factors = objectFactors(frames, poses, {landmark}, {}, options);
  ASSERT_EQ(factors.sightings.size(), 3u);
  for (const auto& sighting : factors.sightings) {
    const double node_yaw = planarPart(poses.node(sighting.node).world_from_robot).yaw;
    EXPECT_TRUE(sighting.has_yaw);
    EXPECT_NEAR(wrapAngle(node_yaw + sighting.yaw_in_robot - kTrueYaw), 0, 1e-9);
  }
  FactorGraph graph;
  for (const auto& node : poses.nodes()) graph.addPose(node.id, node.world_from_robot, true);
  graph.addLandmark(landmark.id, {landmark.position, 0.5, landmark.shape});
  for (const auto& [id, view] : factors.views) graph.addLandmark(id, view);
  for (const auto& factor : factors.shared_errors) graph.add(factor);
  for (const auto& factor : factors.sightings) graph.add(factor);
  ASSERT_TRUE(graph.optimize().usable);
  EXPECT_NEAR(wrapAngle(graph.landmark(landmark.id).yaw - kTrueYaw), 0, 1e-3);
}

// Two of seven sightings took width for depth: what they say of the sizes is left out.
TEST(ObjectFactors, SightingsFromTheSideTellNoSize) {
  const MotionSource none(MotionNoise{}, true);
  const Motion motion{none, none, none};
  const KeyPoses poses = twoVisits(motion);
  auto frames = framesWithYaws(poses);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    auto& proposal = frames[i].decisions[0].seen.measurement.proposal;
    proposal.shape = {ShapeKind::kCuboid, isTurned(i) ? 0.9 : 1.8, isTurned(i) ? 1.8 : 0.9, 0.8};
    proposal.size_information.setConstant(1e6);
  }
  const auto database = ObjectDatabase::fromText(
      "[swivel_chair]\nlabels = chair\nshape = cuboid\nwidth_m = 1.7\ndepth_m = 1\nheight_m = "
      ".8\nwidth_sigma_m = .3\n"
      "depth_sigma_m = .3\nheight_sigma_m = .1\n",
      "test");
  Landmark landmark = chair();
  landmark.yaw = kTrueYaw;
  landmark.has_yaw = true;
  const ObjectFactors factors = objectFactors(frames, poses, {landmark}, database, BackendOptions{});
  int told = 0;
  for (const auto& factor : factors.sizes) {
    if (factor.sigma_m[0] > 0.2 || factor.at_least) continue;  // the usual size, and the least
    EXPECT_LT((factor.size_m - Eigen::Vector3d(1.8, 0.9, 0.8)).norm(), 1e-3) << factor.size_m.transpose();
    ++told;
  }
  EXPECT_GT(told, 0);
}

TEST(ObjectFactors, StandingStillIsOneVisit) {
  const MotionSource none(MotionNoise{}, true);
  const Motion motion{none, none, none};
  KeyPoses poses(motion);
  for (int i = 0; i < 4; ++i) poses.add(5 * i, Pose3::Identity());
  const ObjectFactors factors = objectFactors(framesOf(poses), poses, {chair()}, {}, BackendOptions{});
  EXPECT_EQ(factors.views.size(), 1u);
  EXPECT_EQ(factors.sightings.size(), 1u);
}

// Boxes of one direction repeat their error: a hundred are worth no more than a dozen, and a graph must not grow with time.
TEST(ObjectFactors, BoxesFromOneDirectionAreFewAndSpreadOverTime) {
  constexpr int kPoses = 100;
  const MotionSource none(MotionNoise{}, true);
  const Motion motion{none, none, none};
  KeyPoses poses(motion);
  for (int i = 0; i < kPoses; ++i) poses.add(i, poseFromYpr(0.002 * i, 0, 0, 0.3, 0, 0));
  auto frames = framesOf(poses);
  for (auto& frame : frames) {
    frame.camera = {640, 480, 500, 500, 319.5, 239.5, {}};
    frame.robot_from_camera.linear() = bodyFromOptical();
    auto& seen = frame.decisions[0].seen.measurement;
    seen.proposal.shape = {ShapeKind::kCylinder, 0.6, 0.6, 0.9};
    seen.proposal.camera_from_object = frame.robot_from_camera.inverse() * seen.proposal.camera_from_object;
    seen.detection.box = projectShape(seen.proposal.shape, seen.proposal.camera_from_object, frame.camera)->visible;
  }
  BackendOptions options;
  options.landmark_repeating_share = 0.5;
  const auto boxes = objectFactors(frames, poses, {chair()}, {}, options).boxes;
  ASSERT_EQ(boxes.size(), 12u);
  EXPECT_EQ(boxes.front().node, poses.nodes().front().id);
  EXPECT_EQ(boxes.back().node, poses.nodes().back().id);
  for (const auto& box : boxes) EXPECT_NEAR(box.weight, 0.8 / (1 + 0.5 * 11), 1e-12) << "a mean of twelve, not of a hundred";
  frames.resize(5);
  const auto all = objectFactors(frames, poses, {chair()}, {}, options).boxes;
  ASSERT_EQ(all.size(), 5u);
  EXPECT_NEAR(all[2].weight, 0.8 / (1 + 0.5 * 4), 1e-12);
}

TEST(ObjectFactors, SightingsThatWeighNothingMakeNoView) {
  const MotionSource none(MotionNoise{}, true);
  const Motion motion{none, none, none};
  const KeyPoses poses = twoVisits(motion);
  auto frames = framesOf(poses);
  for (auto& frame : frames) frame.decisions[0].seen.measurement.proposal.score = 0;
  const ObjectFactors factors = objectFactors(frames, poses, {chair()}, shippedObjects(), BackendOptions{});
  EXPECT_TRUE(factors.views.empty());
  EXPECT_TRUE(factors.sightings.empty());
  EXPECT_TRUE(factors.sizes.empty()) << "what no view ties to the poses is not in the graph";
  EXPECT_TRUE(factors.boxes.empty() && factors.insides.empty());
}

Landmark trusted(std::int64_t id) {
  Landmark landmark;
  landmark.id = LandmarkId{id};
  landmark.existence = 0.9;
  landmark.observations = 10;
  return landmark;
}

TEST(SplitByTime, TheTwoVisitsShareNoLandmark) {
  const std::vector<Landmark> landmarks{trusted(0), trusted(1), trusted(2), trusted(3), trusted(4)};
  const std::map<LandmarkId, SeenSpan> spans{{LandmarkId{0}, {0, 20}},
                                             {LandmarkId{1}, {5, 22}},
                                             {LandmarkId{2}, {18, 90}},  // seen in both
                                             {LandmarkId{3}, {80, 95}},
                                             {LandmarkId{4}, {85, 99}}};
  const auto visits = splitByTime(landmarks, spans, 100, 40, 2);
  ASSERT_EQ(visits.size(), 1u);
  ASSERT_EQ(visits[0].recent.size(), 2u);
  EXPECT_EQ(visits[0].recent[0].id.value, 3);
  ASSERT_EQ(visits[0].old.size(), 2u);
  EXPECT_EQ(visits[0].old[1].id.value, 1);
  EXPECT_TRUE(splitByTime(landmarks, spans, 100, 40, 3).empty());
  EXPECT_TRUE(splitByTime(landmarks, spans, 100, 10, 2).empty()) << "the split lies too far back";
  auto doubtful = landmarks;
  doubtful[3].existence = 0.2;
  EXPECT_TRUE(splitByTime(doubtful, spans, 100, 40, 2).empty());
}

}  // namespace
}  // namespace roomgraph::test
