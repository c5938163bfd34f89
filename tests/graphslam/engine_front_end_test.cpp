// SPDX-License-Identifier: BSD-3-Clause
// Front ends behind an engine: movements against the truth of the tiny room, nodes, objects in their places.
#include "roomgraph/graphslam/engine_front_end.h"

#include <gmock/gmock.h>

#include "roomgraph/datasets/rawlog_objects.h"
#include "roomgraph/evaluation/trajectory_file.h"

namespace roomgraph {
namespace {

const std::filesystem::path kSources = ROOMGRAPH_SOURCE_DIR;
const std::filesystem::path kTinyRoom = kSources / "rawlogs" / "tiny_room.rawlog";

std::unique_ptr<Setup> setupWith(const std::string& config) {
  return makeSetup(Config::fromText(config, "test"), kSources / "objects.ini");
}

const std::string kNoImages = "[tracking]\nenabled = false\n[detection]\nenabled = false\n";
const std::string kQuick = "[tracking]\nmax_features = 900\n";

/// Hands the recording over as an engine would: each observation once by two deciders. Keeps a node every half second.
struct Fed {
  explicit Fed(EngineFrontEnd& front_end) {
    RawlogObjects recording(kTinyRoom);
    while (const auto object = recording.next()) {
      front_end.take({nullptr, nullptr, object});
      front_end.take({nullptr, nullptr, object});
      const auto now = front_end.now();
      if (!now || (front_end.nodes() > 0 && *now < front_end.timeOf(last(front_end)) + 0.5)) continue;
      const Pose3 before = front_end.nodes() > 0 ? front_end.poses().node(last(front_end)).world_from_robot : Pose3::Identity();
      const Pose3 moved = front_end.nodes() > 0 ? front_end.movementSince(front_end.timeOf(last(front_end)), true).a_from_b
                                                : Pose3::Identity();
      front_end.noteNodes(front_end.nodes() + 1, *now);
      front_end.setNode(last(front_end), before * moved);
    }
    front_end.end();
  }
  static NodeId last(const EngineFrontEnd& front_end) {
    return NodeId{static_cast<std::int64_t>(front_end.nodes()) - 1};
  }
};

TEST(EngineFrontEnd, MovesAsTheRobotDid) {
  EngineFrontEnd front_end(setupWith(kNoImages), kTinyRoom);
  EXPECT_FALSE(front_end.now());
  const Fed fed(front_end);
  EXPECT_EQ(front_end.counts().scans, 40) << "each observation counts once";
  EXPECT_EQ(front_end.counts().scans_unmatched, 0);
  EXPECT_EQ(front_end.counts().frames, 0);
  ASSERT_GT(front_end.nodes(), 12u);
  const Trajectory truth = readTrajectory(kSources / "share/mrpt/tiny_room.groundtruth.txt").trajectory;
  const auto moved = truth.between(front_end.timeOf(NodeId{0}), front_end.timeOf(Fed::last(front_end)), 0.1);
  ASSERT_TRUE(moved);
  const Pose3 found = front_end.poses().node(Fed::last(front_end)).world_from_robot;
  EXPECT_GT(moved->translation().norm(), 1.5);
  EXPECT_LT((found.translation() - moved->translation()).norm(), 0.05);
  EXPECT_LT(rotationAngle(found.inverse() * *moved), 0.03);
}

TEST(EngineFrontEnd, TellsMovementsOfStepsAndOfLocalMaps) {
  EngineFrontEnd front_end(setupWith(kNoImages), kTinyRoom);
  const Fed fed(front_end);
  const double t = front_end.timeOf(NodeId{static_cast<std::int64_t>(front_end.nodes()) - 4});
  const Movement best = front_end.movementSince(t, true), step = front_end.stepSince(t, true);
  const auto local = front_end.inLocalMapSince(t);
  ASSERT_EQ(local.size(), 1u) << "scans alone";
  EXPECT_LT((best.a_from_b.translation() - local[0].a_from_b.translation()).norm(), 1e-9);
  EXPECT_LT((best.a_from_b.translation() - step.a_from_b.translation()).norm(), 0.1);
  EXPECT_GT((best.a_from_b.translation() - step.a_from_b.translation()).norm(), 1e-6) << "wheels are not scans";
  EXPECT_LT(local[0].covariance(0, 0), best.covariance(0, 0)) << "matches do not add up in a local map";
  const Movement unknown = front_end.movementSince(t - 1e6, true);
  EXPECT_EQ(unknown.a_from_b.translation().norm(), 0);
  EXPECT_GT(unknown.covariance(0, 0), 1e6);
}

TEST(EngineFrontEnd, NodesAreInOrderOfTime) {
  EngineFrontEnd front_end(setupWith(kNoImages), kTinyRoom);
  front_end.noteNodes(2, 10);
  front_end.noteNodes(2, 99);
  front_end.noteNodes(3, 10);
  EXPECT_EQ(front_end.nodes(), 3u);
  EXPECT_EQ(front_end.timeOf(NodeId{0}), 10);
  EXPECT_LT(front_end.timeOf(NodeId{0}), front_end.timeOf(NodeId{1}));
  EXPECT_LT(front_end.timeOf(NodeId{1}), front_end.timeOf(NodeId{2}));
  EXPECT_NEAR(front_end.timeOf(NodeId{2}), 10, 1e-9);
  EXPECT_TRUE(front_end.takeScanClosures().empty());
  EXPECT_TRUE(front_end.takeObjectClosures().empty()) << "no objects are mapped";
  EXPECT_TRUE(front_end.takeSeenObjects().empty());
}

// Two chairs, a sofa and a plant stand in the room; the robot begins at (0.8, 1.2), facing along x.
TEST(EngineFrontEnd, SeesObjectsWhereTheyAre) {
  EngineFrontEnd front_end(setupWith(kQuick), kTinyRoom);
  front_end.mapObjects(setupWith(kQuick));
  const Fed fed(front_end);
  std::map<NodeId, std::vector<SeenObject>> seen;
  for (auto& [node, object] : front_end.takeSeenObjects()) seen[node].push_back(object);
  ASSERT_GE(seen.size(), 5u) << "nodes with objects";
  EXPECT_TRUE(front_end.takeSeenObjects().empty()) << "they are taken";
  std::vector<std::pair<Pose3, std::vector<SeenObject>>> nodes;
  for (const auto& [id, objects] : seen) nodes.emplace_back(front_end.poses().node(id).world_from_robot, objects);
  const auto confirmed = front_end.confirmedLandmarks();
  int chairs = 0;
  for (const auto& [id, object] : placeObjects(nodes)) {
    if (object.class_name != "swivel_chair" || !confirmed.contains(id)) continue;
    const Eigen::Vector2d in_room = object.position.head<2>() + Eigen::Vector2d(0.8, 1.2);
    const double off = std::min((in_room - Eigen::Vector2d(3.3, 2.75)).norm(), (in_room - Eigen::Vector2d(3.85, 1.95)).norm());
    EXPECT_LT(off, 0.25) << in_room.transpose();
    ++chairs;
  }
  EXPECT_EQ(chairs, 2);
}

}  // namespace
}  // namespace roomgraph
