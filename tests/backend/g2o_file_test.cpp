// SPDX-License-Identifier: BSD-3-Clause
// g2o output against the poses, edges and information matrices put in.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "roomgraph/backend/factor_graph.h"
#include "roomgraph/backend/g2o_file.h"
#include "roomgraph/core/errors.h"
#include "simulated_loop.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

struct Line {
  std::string tag;
  std::vector<double> values;
};

std::vector<Line> parse(const std::string& text) {
  std::vector<Line> lines;
  std::istringstream in(text);
  for (std::string row; std::getline(in, row);) {
    std::istringstream words(row);
    Line line;
    words >> line.tag;
    if (line.tag == "#") words.setstate(std::ios::eofbit);
    for (double value = 0; words >> value;) line.values.push_back(value);
    EXPECT_TRUE(words.eof()) << "not a number in: " << row;
    lines.push_back(line);
  }
  return lines;
}

void expectTransform(const std::vector<double>& values, std::size_t from, const Pose3& pose) {
  ASSERT_GE(values.size(), from + 7);
  const double* v = values.data() + from;
  EXPECT_LT((Eigen::Vector3d(v[0], v[1], v[2]) - pose.translation()).norm(), 1e-12);
  EXPECT_LT((Eigen::Quaterniond(v[6], v[3], v[4], v[5]).toRotationMatrix() - pose.linear()).norm(), 1e-12);
}

void expectUpperTriangle(const std::vector<double>& values, std::size_t from, const Matrix6d& information) {
  ASSERT_EQ(values.size(), from + 21);
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j, ++from)
      EXPECT_NEAR(values[from], information(i, j), 1e-9 * information.norm()) << i << ", " << j;
}

// g2o's error is turned into the measured b frame and has half the rotation vector.
Matrix6d inG2oConvention(const Pose3& measured, const Matrix6d& information) {
  Matrix6d ours_from_g2o = Matrix6d::Zero();
  ours_from_g2o.topLeftCorner<3, 3>() = measured.linear();
  ours_from_g2o.bottomRightCorner<3, 3>() = 2 * Eigen::Matrix3d::Identity();
  return ours_from_g2o.transpose() * information * ours_from_g2o;
}

TEST(G2oFile, HoldsEveryVertexAndEdgeInOrder) {
  SimulatedLoop loop(7, 3);
  FactorGraph graph;
  for (int i = 0; i < 3; ++i) graph.addPose(NodeId{i}, loop.truth()[static_cast<std::size_t>(i)], i == 0);
  graph.addLandmark(LandmarkId{2}, loop.objects()[2]);
  BetweenFactor movement = loop.movement(0, 1);
  movement.covariance(0, 5) = movement.covariance(5, 0) = 1e-4;
  const BetweenFactor second = loop.movement(1, 2);
  const LandmarkFactor with_yaw = loop.sighting(1, 2), without_yaw = loop.sighting(2, 2, false);
  graph.add(movement);
  graph.add(second);
  graph.add(with_yaw);
  graph.add(without_yaw);
  TemporaryFolder folder;
  graph.saveG2o(folder.file("graph.g2o"));

  const auto lines = parse(folder.read("graph.g2o"));
  const std::vector<std::string> tags = {
      "VERTEX_SE3:QUAT", "FIX",           "VERTEX_SE3:QUAT", "VERTEX_SE3:QUAT", "#",
      "VERTEX_SE3:QUAT", "EDGE_SE3:QUAT", "EDGE_SE3:QUAT",   "EDGE_SE3:QUAT",   "EDGE_SE3:QUAT"};
  ASSERT_EQ(lines.size(), tags.size());
  for (std::size_t i = 0; i < tags.size(); ++i) EXPECT_EQ(lines[i].tag, tags[i]) << "line " << i + 1;
  EXPECT_EQ(lines[1].values, std::vector<double>{0});
  for (std::size_t i : {0u, 1u, 2u}) {
    const auto& vertex = lines[i == 0 ? 0 : i + 1].values;
    EXPECT_EQ(vertex.size(), 8u);
    EXPECT_EQ(vertex[0], static_cast<double>(i));
    expectTransform(vertex, 1, loop.truth()[i]);
  }
  // Landmarks are numbered behind the poses: 3 + 2.
  EXPECT_EQ(lines[5].values[0], 5);
  const auto& object = loop.objects()[2];
  expectTransform(
      lines[5].values, 1,
      poseFromYpr(object.position.x(), object.position.y(), object.position.z(), object.yaw, 0, 0));
  EXPECT_EQ(lines[6].values[0], 0);
  EXPECT_EQ(lines[6].values[1], 1);
  expectTransform(lines[6].values, 2, movement.a_from_b);
  expectUpperTriangle(lines[6].values, 9, inG2oConvention(movement.a_from_b, movement.covariance.inverse()));
  expectTransform(lines[7].values, 2, second.a_from_b);
  EXPECT_EQ(lines[8].values[0], 1);
  EXPECT_EQ(lines[8].values[1], 5);
  const auto& p = with_yaw.position_in_robot;
  const Pose3 seen = poseFromYpr(p.x(), p.y(), p.z(), with_yaw.yaw_in_robot, 0, 0);
  expectTransform(lines[8].values, 2, seen);
  Matrix6d information = Matrix6d::Zero();
  for (int i : {0, 1, 2}) information(i, i) = 1 / with_yaw.covariance(i, i);
  const Matrix6d unturned = information;
  information(5, 5) = 1 / with_yaw.covariance(3, 3);
  information = inG2oConvention(seen, information);
  for (int i : {3, 4}) information(i, i) = 1e-3;
  expectUpperTriangle(lines[8].values, 9, information);
  EXPECT_EQ(lines[9].values[0], 2);
  information = unturned;
  for (int i : {3, 4, 5}) information(i, i) = 1e-3;
  expectUpperTriangle(lines[9].values, 9, information);
}

// The information of such a sighting cannot be told from none: a file that holds it could not be read again.
TEST(G2oFile, SightingThatWeighsNothingIsLeftOut) {
  SimulatedLoop loop(7, 3);
  FactorGraph graph;
  for (int i = 0; i < 2; ++i) graph.addPose(NodeId{i}, loop.truth()[static_cast<std::size_t>(i)], i == 0);
  graph.addLandmark(LandmarkId{2}, loop.objects()[2]);
  graph.add(loop.movement(0, 1));
  for (const double weight : {1.0, 1e-300, 1e-20, 0.0}) {
    LandmarkFactor sighting = loop.sighting(1, 2);
    sighting.weight = weight;
    graph.add(sighting);
  }
  TemporaryFolder folder;
  graph.saveG2o(folder.file("graph.g2o"));
  const auto lines = parse(folder.read("graph.g2o"));
  EXPECT_EQ(std::count_if(lines.begin(), lines.end(), [](const Line& l) { return l.tag == "EDGE_SE3:QUAT"; }),
            2);
  EXPECT_NO_THROW(loadG2o(folder.file("graph.g2o")));
}

TEST(G2oFile, UnwritablePlaceIsAnErrorThatNamesIt) {
  TemporaryFolder folder;
  folder.write("file", "");
  try {
    FactorGraph().saveG2o(folder.path() / "file" / "graph.g2o");
    FAIL() << "no exception";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("graph.g2o"), std::string::npos);
  }
}

}  // namespace
}  // namespace roomgraph::test
