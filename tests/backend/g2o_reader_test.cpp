// SPDX-License-Identifier: BSD-3-Clause
// g2o reader: round trips, chi-squared by definition, malformed files, published optima.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "data_folder.h"
#include "errors_of.h"
#include "roomgraph/backend/g2o_file.h"
#include "roomgraph/core/errors.h"
#include "simulated_loop.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;

// Noisy loop with full, random information matrices, without robust losses.
FactorGraph randomGraph(unsigned seed, bool landmarks) {
  SimulatedLoop loop(seed, 12);
  Random random(seed);
  FactorGraph graph;
  for (int i = 0; i < loop.size(); ++i)
    graph.addPose(NodeId{i}, loop.truth()[static_cast<std::size_t>(i)] * random.pose(i ? 0.1 : 0, 0.1),
                  i == 0);
  for (int i = 0; i < loop.size(); ++i) {
    BetweenFactor f = loop.movement(i, (i + 1) % loop.size());
    Matrix6d root;
    for (auto& value : root.reshaped()) value = random.uniform(-0.03, 0.03);
    f.covariance += root * root.transpose();
    graph.add(f);
  }
  for (int k = 0; landmarks && k < 3; ++k) {
    LandmarkEstimate start = loop.objects()[static_cast<std::size_t>(k)];
    start.shape = {k == 0 ? ShapeKind::kCylinder : ShapeKind::kCuboid, 0.6, 0.6, 0.9};
    graph.addLandmark(LandmarkId{2 * k}, start);
    for (int i = k; i < loop.size(); i += 3) {
      LandmarkFactor f = loop.sighting(i, k, i % 2 == 0);
      f.landmark = LandmarkId{2 * k};
      f.weight = random.uniform(0.2, 1);
      f.covariance(0, 3) = f.covariance(3, 0) = 1e-3;
      graph.add(f);
    }
  }
  return graph;
}

TEST(G2oReader, SaveLoadOptimiseGivesTheSameChiSquaredAndPoses) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    FactorGraph graph = randomGraph(seed, seed % 2 == 0);
    TemporaryFolder folder;
    graph.saveG2o(folder.file("graph.g2o"));
    G2oContent content = loadG2o(folder.file("graph.g2o"));
    EXPECT_TRUE(content.skipped.empty());
    auto& loaded = std::get<FactorGraph>(content.graph);
    EXPECT_EQ(loaded.poses(), graph.poses());
    EXPECT_EQ(loaded.landmarks(), graph.landmarks());
    EXPECT_EQ(loaded.factors(), graph.factors());
    EXPECT_NEAR(loaded.chiSquared(), graph.chiSquared(), 1e-7 * graph.chiSquared());
    const SolveOptions options{100, 1e-14};
    const SolveReport a = graph.optimize(options), b = loaded.optimize(options);
    EXPECT_LT(a.final_cost, 0.5 * a.initial_cost);
    EXPECT_NEAR(a.final_cost, b.final_cost, 1e-8 * a.final_cost);
    for (int i = 0; i < 12; ++i)
      EXPECT_TRUE(loaded.pose(NodeId{i}).isApprox(graph.pose(NodeId{i}), 1e-6)) << "seed " << seed;
    for (int k = 0; seed % 2 == 0 && k < 6; k += 2) {
      const auto x = loaded.landmark(LandmarkId{k}), y = graph.landmark(LandmarkId{k});
      EXPECT_LT((x.position - y.position).norm(), 1e-6);
      EXPECT_NEAR(wrapAngle(x.yaw - y.yaw), 0, 1e-6);
      EXPECT_EQ(x.shape.kind, y.shape.kind);
      EXPECT_EQ(x.shape.height, y.shape.height);
    }
  }
}

// Sum of e' Omega e as g2o defines it, from the numbers in the file alone.
double chiSquaredOfText(const std::string& text) {
  std::map<int, Pose3> vertices;
  std::istringstream in(text);
  double sum = 0;
  const auto transform = [](std::istream& row) {
    double v[7];
    for (double& value : v) row >> value;
    Pose3 pose = Pose3::Identity();
    pose.linear() = Eigen::Quaterniond(v[6], v[3], v[4], v[5]).toRotationMatrix();
    pose.translation() = Eigen::Vector3d(v[0], v[1], v[2]);
    return pose;
  };
  for (std::string line, tag; std::getline(in, line);) {
    std::istringstream row(line);
    int a = 0, b = 0;
    row >> tag >> a;
    if (tag == "VERTEX_SE3:QUAT") vertices[a] = transform(row);
    if (tag != "EDGE_SE3:QUAT") continue;
    row >> b;
    const Pose3 error = transform(row).inverse() * vertices.at(a).inverse() * vertices.at(b);
    Eigen::Quaterniond q(error.linear());
    if (q.w() < 0) q.coeffs() *= -1;
    Vector6d e;
    e << error.translation(), q.vec();
    Matrix6d information;
    for (int i = 0; i < 6; ++i)
      for (int j = i; j < 6; ++j) {
        row >> information(i, j);
        information(j, i) = information(i, j);
      }
    sum += e.dot(information * e);
  }
  return sum;
}

TEST(G2oReader, ChiSquaredIsWhatG2oDefines) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const FactorGraph graph = randomGraph(seed, false);
    TemporaryFolder folder;
    graph.saveG2o(folder.file("graph.g2o"));
    EXPECT_NEAR(chiSquaredOfText(folder.read("graph.g2o")), graph.chiSquared(), 1e-7 * graph.chiSquared());
  }
}

TEST(G2oReader, PlanarGraphRoundTripAndStart) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    PlanarGraph graph;
    std::vector<Pose2> truth;
    for (int i = 0; i < 20; ++i) {
      const double angle = 2 * M_PI * i / 20;
      truth.push_back({3 * std::cos(angle), 3 * std::sin(angle), wrapAngle(angle + M_PI / 2)});
      graph.poses[NodeId{i}] = i == 0 ? truth[0] : Pose2{random.uniform(-3, 3), random.uniform(-3, 3), 3};
    }
    graph.fixed = {NodeId{0}};
    for (int i = 0; i < 20; ++i) {
      const Pose2& a = truth[static_cast<std::size_t>(i)];
      const Pose2& b = truth[static_cast<std::size_t>((i + 1) % 20)];
      Pose2 seen = a.inverse() * b;
      seen.x += 0.02 * gauss(random);
      seen.yaw += 0.01 * gauss(random);
      const Eigen::Vector3d information(2500, 2500, 10000);
      graph.edges.push_back({NodeId{i}, NodeId{(i + 1) % 20}, seen, information.asDiagonal()});
    }
    const double scattered = chiSquared(graph);
    EXPECT_TRUE(initializePoses(graph));
    EXPECT_LT(chiSquared(graph), 1e-3 * scattered);
    TemporaryFolder folder;
    saveG2o(graph, folder.file("graph.g2o"));
    G2oContent content = loadG2o(folder.file("graph.g2o"));
    auto& loaded = std::get<PlanarGraph>(content.graph);
    EXPECT_NEAR(chiSquared(loaded), chiSquared(graph), 1e-9 * chiSquared(graph));
    ASSERT_TRUE(optimize(graph).usable && optimize(loaded).usable);
    EXPECT_LT(chiSquared(graph), 20);  // 3 freedoms
    for (const auto& [id, pose] : graph.poses) {
      EXPECT_NEAR(loaded.poses.at(id).x, pose.x, 1e-9);
      EXPECT_LT(std::hypot(pose.x - truth[static_cast<std::size_t>(id.value)].x,
                           pose.y - truth[static_cast<std::size_t>(id.value)].y),
                0.3);
    }
  }
}

TEST(G2oReader, ChordalStartSolvesAnExactSpatialGraphAlone) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    std::vector<Pose3> truth;
    FactorGraph graph;
    for (int i = 0; i < 15; ++i) {
      truth.push_back(random.pose(4));
      graph.addPose(NodeId{i}, i == 0 ? truth[0] : random.pose(4), i == 0);
    }
    for (int i = 0; i < 40; ++i) {
      const int a = i < 14 ? i : random.index(15), b = i < 14 ? i + 1 : random.index(15);
      if (a == b) continue;
      graph.add(
          BetweenFactor{NodeId{a}, NodeId{b},
                        truth[static_cast<std::size_t>(a)].inverse() * truth[static_cast<std::size_t>(b)]});
    }
    EXPECT_TRUE(graph.initializePoses());
    EXPECT_LT(graph.chiSquared(), 1e-16);
    for (int i = 0; i < 15; ++i)
      EXPECT_TRUE(graph.pose(NodeId{i}).isApprox(truth[static_cast<std::size_t>(i)], 1e-9))
          << "seed " << seed;
  }
}

TEST(G2oReader, CommentsBlankLinesAndUnknownTags) {
  TemporaryFolder folder;
  const auto file = folder.write("a.g2o",
                                 "# a comment\n\nPARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\nVERTEX_SE2 4 1 2 0.5\n"
                                 "EDGE_SE2 4 7 1 0 0 1 0 0 1 0 1\nVERTEX_SE2 7 2 2 0.5\nODD\nODD 1\n");
  const G2oContent content = loadG2o(file);
  EXPECT_EQ(content.skipped, (std::map<std::string, int>{{"ODD", 2}, {"PARAMS_SE3OFFSET", 1}}));
  const auto& graph = std::get<PlanarGraph>(content.graph);
  EXPECT_EQ(graph.poses.size(), 2u);
  EXPECT_EQ(graph.edges.size(), 1u);
  EXPECT_EQ(graph.fixed, std::set<NodeId>{NodeId{4}}) << "without FIX the first pose is held";
  const auto held = folder.write("b.g2o", "VERTEX_SE2 4 1 2 0.5\nVERTEX_SE2 7 2 2 0.5\nFIX 7\n");
  EXPECT_EQ(std::get<PlanarGraph>(loadG2o(held).graph).fixed, std::set<NodeId>{NodeId{7}});
}

TEST(G2oReader, ErrorsNameFileAndLine) {
  TemporaryFolder folder;
  const auto errorOf = [&](const std::string& text) {
    const auto file = folder.write("bad.g2o", text);
    return messageOf<InputError>([&] { loadG2o(file); });
  };
  const std::string two = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n";
  EXPECT_THAT(errorOf("VERTEX_SE2 0 0 zero 0\n"), HasSubstr("bad.g2o:1: VERTEX_SE2: a coordinate"));
  EXPECT_THAT(errorOf("\nVERTEX_SE2 0 0 nan 0\n"), HasSubstr("bad.g2o:2: "));
  EXPECT_THAT(errorOf("VERTEX_SE2 0 0 0 0 5\n"), HasSubstr("'5' is too much"));
  EXPECT_THAT(errorOf("VERTEX_SE2 -1 0 0 0\n"), HasSubstr("an id is missing"));
  EXPECT_THAT(errorOf(two + "VERTEX_SE2 1 1 0 0\n"),
              HasSubstr("bad.g2o:3: vertex 1 stands in the file twice"));
  EXPECT_THAT(errorOf(two + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0\n"), HasSubstr("information matrix is missing"));
  EXPECT_THAT(errorOf(two + "EDGE_SE2 0 1 1 0 0 1 2 0 1 0 1\n"), HasSubstr("not positive definite"));
  EXPECT_THAT(errorOf(two + "EDGE_SE2 0 9 1 0 0 1 0 0 1 0 1\n"), HasSubstr("bad.g2o:3: edge to vertex 9"));
  EXPECT_THAT(errorOf(two + "EDGE_SE2 1 1 1 0 0 1 0 0 1 0 1\n"), HasSubstr("to itself"));
  EXPECT_THAT(errorOf(two + "FIX 5\n"), HasSubstr("bad.g2o:3: FIX of vertex 5"));
  EXPECT_THAT(errorOf(two + "VERTEX_SE3:QUAT 2 0 0 0 0 0 0 1\n"), HasSubstr("2D and 3D"));
  EXPECT_THAT(errorOf("VERTEX_SE3:QUAT 2 0 0 0 0 0 0 2\n"), HasSubstr("quaternion's length"));
  EXPECT_THAT(errorOf("# LANDMARK 3 0 ball 1 1 1\n"), HasSubstr("'ball' is no shape"));
  const std::string named = two + "# LANDMARK 1 7 cylinder 1 1 1\n";
  EXPECT_THAT(errorOf(named + "# LANDMARK 0 7 cylinder 1 1 1\n"), HasSubstr("bad.g2o:4: landmark 7"));
  EXPECT_THAT(errorOf(named + "# LANDMARK 1 8 cylinder 1 1 1\n"), HasSubstr("was named before"));
  EXPECT_THAT(errorOf(two + "# LANDMARK 9 7 cylinder 1 1 1\n"), HasSubstr("landmark 7 is vertex 9"));
  EXPECT_THAT(errorOf("# nothing\n"), HasSubstr("holds no VERTEX_SE2"));
  EXPECT_THAT(messageOf<InputError>([&] { loadG2o(folder.file("none.g2o")); }), HasSubstr("none.g2o"));
  EXPECT_THAT(messageOf<InputError>([&] { loadG2o(folder.path()); }), HasSubstr("cannot be opened"));
}

TEST(G2oReader, InformationThatIsLostOnTheWayToACovarianceIsNoInformation) {
  TemporaryFolder folder;
  const std::string two = "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 1 0 0 0 0 0 1\n";
  const auto edge = [&](const std::string& first) {
    return folder.write("bad.g2o", two + "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 " + first +
                                       " 0 0 0 0 0 100 0 0 0 0 100 0 0 0 400 0 0 400 0 400\n");
  };
  EXPECT_NO_THROW(loadG2o(edge("100")));
  EXPECT_NO_THROW(loadG2o(edge("1e-3")));
  EXPECT_THAT(messageOf<InputError>([&] { loadG2o(edge("1e-320")); }),
              HasSubstr("bad.g2o:3: the information matrix is not positive definite"));
}

std::filesystem::path dataFile(const std::string& name) {
  return dataFolder() / "posegraph" / name;
}

TEST(G2oReader, ManhattanReachesItsPublishedOptimum) {
  const auto file = dataFile("manhattan3500.g2o");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file << " (ROOMGRAPH_DATA)";
  G2oContent content = loadG2o(file);
  auto& graph = std::get<PlanarGraph>(content.graph);
  EXPECT_EQ(graph.poses.size(), 3500u);
  initializePoses(graph);
  ASSERT_TRUE(optimize(graph, SolveOptions{100, 1e-12}).usable);
  EXPECT_NEAR(chiSquared(graph), 146.0766, 1e-3);
}

TEST(G2oReader, SphereEndsAtTheSameOptimumFromBothStarts) {
  const auto file = dataFile("sphere2500.g2o");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file << " (ROOMGRAPH_DATA)";
  double chi[2];
  for (int chordal : {0, 1}) {
    G2oContent content = loadG2o(file);
    auto& graph = std::get<FactorGraph>(content.graph);
    if (chordal == 1) {
      EXPECT_TRUE(graph.initializePoses());
    }
    ASSERT_TRUE(graph.optimize(SolveOptions{100, 1e-12}).usable);
    chi[chordal] = graph.chiSquared();
  }
  EXPECT_NEAR(chi[0], chi[1], 1e-6 * chi[1]);
}

}  // namespace
}  // namespace roomgraph::test
