// SPDX-License-Identifier: BSD-3-Clause
// Planar projection of a graph: same error as in 3D, landmarks and times in g2o files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "errors_of.h"
#include "roomgraph/backend/g2o_file.h"
#include "roomgraph/core/errors.h"
#include "simulated_loop.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;

Eigen::Matrix3d someCovariance(Random& random) {
  Eigen::Matrix3d root;
  for (auto& value : root.reshaped()) value = random.uniform(-0.1, 0.1);
  return Eigen::Matrix3d(root * root.transpose()) + 1e-3 * Eigen::Matrix3d::Identity();
}

Pose3 flat(Random& random, double reach, double angle) {
  const Pose2 pose{random.uniform(-reach, reach), random.uniform(-reach, reach),
                   random.uniform(-angle, angle)};
  return toPose3(pose);
}

// Poses, movements, sightings and views in the plane, with covariances that couple x, y and yaw.
FactorGraph flatGraph(unsigned seed) {
  Random random(seed);
  FactorGraph graph;
  std::vector<Pose3> poses;
  for (int i = 0; i < 8; ++i) {
    poses.push_back(flat(random, 5, 3));
    graph.addPose(NodeId{2 * i}, poses.back(), i == 0);
  }
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    BetweenFactor f{NodeId{static_cast<int>(2 * i)}, NodeId{static_cast<int>(2 * i + 2)}};
    f.a_from_b = poses[i].inverse() * poses[i + 1] * flat(random, 0.1, 0.02);
    const Eigen::Matrix3d covariance = someCovariance(random);
    const int rows[] = {0, 1, 5};
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) f.covariance(rows[r], rows[c]) = covariance(r, c);
    graph.add(f);
  }
  const Pose2 object{1, -2, 0.7};
  graph.addLandmark(LandmarkId{3}, {{object.x, object.y, 0}, object.yaw, {ShapeKind::kCuboid, 1, 2, 3}});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose2 seen = planarPart(poses[i].inverse() * toPose3(object) * flat(random, 0.1, 0.02));
    LandmarkFactor f{
        NodeId{static_cast<int>(2 * i)}, LandmarkId{3}, {seen.x, seen.y, 0}, seen.yaw, i % 2 == 0};
    const Eigen::Matrix3d covariance = someCovariance(random);
    const int rows[] = {0, 1, 3};
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) f.covariance(rows[r], rows[c]) = covariance(r, c);
    f.weight = random.uniform(0.2, 1);
    f.robust_width = 0;
    graph.add(f);
  }
  for (const int id : {4, 5}) {
    const Pose2 view{object.x + random.uniform(-0.2, 0.2), object.y + random.uniform(-0.2, 0.2),
                     object.yaw + 0.1};
    graph.addLandmark(LandmarkId{id}, {{view.x, view.y, 0}, view.yaw, {ShapeKind::kCuboid, 1, 2, 3}});
    LandmarkViewFactor f{.view = LandmarkId{id}, .landmark = LandmarkId{3}, .has_yaw = id == 4};
    if (f.has_yaw) f.offset_m = {0.1, -0.2};
    const Eigen::Matrix3d covariance = someCovariance(random);
    const int rows[] = {0, 1, 3};
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) f.covariance(rows[r], rows[c]) = covariance(r, c);
    // Without a yaw the file has the same variance in all directions.
    if (!f.has_yaw) f.covariance = 0.01 * Eigen::Matrix4d::Identity();
    f.weight = random.uniform(0.2, 1);
    f.robust_width = 0;
    graph.add(f);
  }
  return graph;
}

TEST(PlanarProjection, HasTheErrorOfTheSpatialGraph) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const FactorGraph graph = flatGraph(seed);
    const PlanarGraph planar = graph.planar();
    EXPECT_EQ(planar.poses.size(), 11u);
    EXPECT_EQ(planar.edges.size(), graph.factors());
    EXPECT_EQ(planar.fixed, std::set<NodeId>{NodeId{0}});
    // The token information of a yaw that was not measured adds next to nothing (1e-3 of yaw squared).
    EXPECT_GT(graph.chiSquared(), 5);
    EXPECT_NEAR(chiSquared(planar), graph.chiSquared(), 0.05 + 1e-3 * graph.chiSquared()) << "seed " << seed;
  }
}

TEST(PlanarProjection, FileKeepsLandmarksAndTimes) {
  TemporaryFolder folder;
  const PlanarGraph planar = flatGraph(1).planar();
  const NodeTimes times{{NodeId{0}, 1700000000.25}, {NodeId{4}, 1700000001.123456}};
  saveG2o(planar, folder.file("a.g2o"), times);
  EXPECT_THAT(folder.read("a.g2o"), HasSubstr("# STAMP 4 1700000001.123456\nVERTEX_SE2 4 "));
  EXPECT_THAT(folder.read("a.g2o"), HasSubstr("# LANDMARK 18 3 cuboid 1 2 3\nVERTEX_SE2 18 "));
  G2oContent content = loadG2o(folder.file("a.g2o"));
  EXPECT_EQ(content.times, times);
  auto& loaded = std::get<PlanarGraph>(content.graph);
  EXPECT_NEAR(chiSquared(loaded), chiSquared(planar), 1e-9);
  ASSERT_TRUE(loaded.landmarks.contains(NodeId{18}));
  EXPECT_EQ(loaded.landmarks.at(NodeId{18}).id, LandmarkId{3});
  ASSERT_TRUE(optimize(loaded).usable);
  EXPECT_LT(chiSquared(loaded), chiSquared(planar));
  saveG2o(loaded, folder.file("b.g2o"), content.times);
  EXPECT_THAT(folder.read("b.g2o"), HasSubstr("# STAMP 4 1700000001.123456\n"));
  EXPECT_THAT(folder.read("b.g2o"), HasSubstr("# LANDMARK 18 3 cuboid 1 2 3\n"));
}

TEST(G2oFile, OfASpatialGraphHasItsErrorAndItsViews) {
  const TemporaryFolder folder;
  const FactorGraph graph = flatGraph(3);
  graph.saveG2o(folder.file("a.g2o"));
  const auto content = loadG2o(folder.file("a.g2o"));
  const auto& loaded = std::get<FactorGraph>(content.graph);
  EXPECT_EQ(loaded.factors(), graph.factors());
  EXPECT_EQ(loaded.landmarks(), 3u);
  EXPECT_NEAR(loaded.chiSquared(), graph.chiSquared(), 1e-6 * graph.chiSquared());
}

TEST(G2oTimes, OfASpatialGraphComeBack) {
  TemporaryFolder folder;
  const FactorGraph graph = flatGraph(2);
  const NodeTimes times{{NodeId{0}, 0}, {NodeId{6}, 12.5}};
  graph.saveG2o(folder.file("with.g2o"), times);
  graph.saveG2o(folder.file("without.g2o"));
  EXPECT_EQ(loadG2o(folder.file("with.g2o")).times, times);
  EXPECT_TRUE(loadG2o(folder.file("without.g2o")).times.empty());
  std::istringstream lines(folder.read("with.g2o"));
  std::string others;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("# STAMP ")) others += line + "\n";
  EXPECT_EQ(others, folder.read("without.g2o")) << "everything else is as it was";
}

TEST(G2oTimes, MakeNoSenseWithoutAVertexOrANumber) {
  TemporaryFolder folder;
  const auto errorOf = [&](const std::string& line) {
    const auto file = folder.write("bad.g2o", "VERTEX_SE2 0 0 0 0\n" + line + "\n");
    return messageOf<InputError>([&] { loadG2o(file); });
  };
  EXPECT_THAT(errorOf("# STAMP 5 1.5"), HasSubstr("bad.g2o:2: time of vertex 5"));
  EXPECT_THAT(errorOf("# STAMP 0 nan"), HasSubstr("bad.g2o:2: # STAMP: the time"));
  EXPECT_THAT(errorOf("# STAMP 0 1 2"), HasSubstr("'2' is too much"));
}

}  // namespace
}  // namespace roomgraph::test
