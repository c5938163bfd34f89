// SPDX-License-Identifier: BSD-3-Clause
// Thinning, binning, gaps and closures against brute force and known values.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "grid_image.h"
#include "made_up_run.h"
#include "path_thinning.h"
#include "pose_curves.h"
#include "roomgraph/report/graph_closures.h"

namespace roomgraph::test {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

std::vector<PathPoint> randomWalk(unsigned seed, int count) {
  std::mt19937 random(seed);
  std::normal_distribution<double> turn(0, 0.2);
  std::vector<PathPoint> path;
  double x = 0, y = 0, yaw = 0;
  for (int i = 0; i < count; ++i) {
    path.push_back({0.1 * i, x, y, yaw});
    yaw += turn(random);
    x += 0.03 * std::cos(yaw);
    y += 0.03 * std::sin(yaw);
  }
  return path;
}

double distanceFromPlaceThen(const PathPoint& p, const PathPoint& a, const PathPoint& b) {
  const double velocity_x = (b.x - a.x) / (b.t - a.t), velocity_y = (b.y - a.y) / (b.t - a.t);
  return std::hypot(a.x + velocity_x * (p.t - a.t) - p.x, a.y + velocity_y * (p.t - a.t) - p.y);
}

TEST(ReportThinning, NoPointIsFartherThanTheTolerance) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto path = randomWalk(seed, 600);
    const auto kept = keptPoints(path, 0.05, 1);
    ASSERT_GE(kept.size(), 2u);
    EXPECT_EQ(kept.front(), 0u);
    EXPECT_EQ(kept.back(), path.size() - 1);
    EXPECT_LT(kept.size(), path.size() / 3);
    for (std::size_t k = 0; k + 1 < kept.size(); ++k)
      for (std::size_t i = kept[k]; i <= kept[k + 1]; ++i)
        EXPECT_LE(distanceFromPlaceThen(path[i], path[kept[k]], path[kept[k + 1]]), 0.0501);
  }
}

TEST(ReportThinning, CornersStayAndStraightsGo) {
  std::vector<PathPoint> path;
  for (int i = 0; i <= 100; ++i)
    path.push_back({1. * i, std::min(i, 50) * 0.1, std::max(0, i - 50) * 0.1, 0});
  EXPECT_THAT(keptPoints(path, 0.01, 2), ElementsAre(0, 50, 100));
}

TEST(ReportThinning, StopsAndGapsStay) {
  std::vector<PathPoint> path;
  for (int i = 0; i <= 50; ++i) path.push_back({0.1 * i, 0.05 * i, 0, 0});
  for (int i = 51; i <= 150; ++i) path.push_back({0.1 * i, 2.5, 0, 0});  // stands
  for (int i = 151; i <= 250; ++i) path.push_back({0.1 * i, 2.5 + 0.05 * (i - 150), 0, 0});
  EXPECT_THAT(keptPoints(path, 0.01, 1), ElementsAre(0, 50, 150, 250));
  for (std::size_t i = 200; i < path.size(); ++i) path[i].t += 20.0044;
  EXPECT_THAT(keptPoints(path, 0.01, 1), ElementsAre(0, 50, 150, 199, 200, 250));
  for (std::size_t i = 200; i < path.size(); ++i) path[i].x += 0.5 * 20.0044;
  EXPECT_THAT(keptPoints(path, 0.01, 1), ElementsAre(0, 50, 150, 199, 200, 250)) << "as if it had gone on all the time";
}

TEST(ReportThinning, LongPathsKeepTheirEndsAndTheLimit) {
  EXPECT_TRUE(thinned({}, 100, 1).empty());
  const auto one = thinned({{1, 2, 3, 4}}, 100, 1);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].y, 3);
  const auto path = randomWalk(4, 9000);
  const auto out = thinned(path, 300, 1);
  EXPECT_LE(out.size(), 300u);
  EXPECT_GT(out.size(), 50u) << "not coarser than needed";
  EXPECT_EQ(out.front().t, path.front().t);
  EXPECT_EQ(out.back().t, path.back().t);
}

TEST(ReportBins, SmallestAndLargestOfEachPart) {
  const auto series = binned({{0, 5}, {1, 3}, {2.4, 4}, {7.5, -1}, {10, 2}, {11, 99}, {3, NAN}}, 0, 10, 4);
  EXPECT_EQ(series.step, 2.5);
  EXPECT_EQ(series.low[0], 3);
  EXPECT_EQ(series.high[0], 5);
  EXPECT_TRUE(std::isnan(series.low[1]) && std::isnan(series.high[1])) << "a value that is none";
  EXPECT_TRUE(std::isnan(series.high[2]));
  EXPECT_EQ(series.low[3], -1);
  EXPECT_EQ(series.high[3], 2) << "the end belongs to the last part, what is behind it to none";
}

TEST(ReportCurves, GapsAreLongerThanASecondAndThanTheUsualSpacing) {
  std::vector<PathPoint> path;
  for (const double t : {0., .1, .2, .3, 1.2, 1.3, 4.3, 4.4}) path.push_back({t, 0, 0, 0});
  EXPECT_THAT(gapsOf(path), ElementsAre(Pair(1.3, 4.3))) << "0.9 s are no gap";
  path.clear();
  for (const double t : {0., 2., 4., 6., 16., 40.}) path.push_back({t, 0, 0, 0});
  EXPECT_THAT(gapsOf(path), ElementsAre(Pair(16., 40.))) << "ten spacings of a slow recording";
  EXPECT_TRUE(gapsOf({}).empty());
}

TEST(ReportCurves, NothingWithoutPairs) {
  Trajectory truth, estimate;
  truth.add(0, Pose3::Identity());
  estimate.add(50, Pose3::Identity());
  EXPECT_FALSE(errorsOf(truth, estimate, 0, 10));
}

TEST(ReportClosures, PlanarGraphsAndOddLines) {
  std::istringstream graph(
      "VERTEX_SE2 5 1 2 0\n# STAMP 5 101\nVERTEX_SE2 7 3 4 0\n# STAMP 7 103\nVERTEX_SE2 9 5 6 0\n# STAMP 9 "
      "105\n"
      "EDGE_SE2 5 7 1 1\nEDGE_SE2 7 9\nEDGE_SE2 5 9\nEDGE_SE2 5\nEDGE_SE2 5 77\nnonsense\n\n# STAMP x\n");
  const auto closures = readClosures(graph, 100);
  ASSERT_EQ(closures.size(), 1u) << "5 and 7 follow each other: there is no key pose between them";
  EXPECT_EQ(closures[0].t_a, 1);
  EXPECT_EQ(closures[0].t_b, 5);
  EXPECT_EQ(closures[0].b[1], 6);
}

// The second pose is 0.5 m and 0.1 rad from where the first one's measurement puts it.
TEST(ReportClosures, ResidualsOfAPlanarEdge) {
  std::istringstream graph(
      "VERTEX_SE2 0 5 5 0.5\n# STAMP 0 1\nVERTEX_SE2 1 0 0 0\n# STAMP 1 2\n"
      "VERTEX_SE2 2 5.4 5.3 0.6\n# STAMP 2 3\nEDGE_SE2 0 2 0 0 0 4 0 0 4 0 100\nEDGE_SE2 0 2 0 0 0 1 2 3\n"
      "# CLOSURE 0 2 lidar\n# CLOSURE 0 2 tracking\n# CLOSURE 0\n");
  const auto closures = readClosures(graph, 0);
  ASSERT_EQ(closures.size(), 2u);
  EXPECT_NEAR(closures[0].off_m, 0.5, 1e-12);
  EXPECT_NEAR(closures[0].off_rad, 0.1, 1e-12);
  EXPECT_NEAR(closures[0].off_sigmas, std::sqrt(4 * 0.25 + 100 * 0.01), 1e-12);
  EXPECT_EQ(closures[0].kind, "lidar");
  EXPECT_EQ(closures[1].kind, "tracking") << "in the order of the edges";
  EXPECT_TRUE(std::isnan(closures[1].off_m)) << "three numbers are no information";
  EXPECT_EQ(closures[1].id_b, 2);
}

// Information between x and y, and on a half-turn's quaternion: e = (.1, .2, 0, sin .2, 0, 0).
TEST(ReportClosures, ResidualsOfASpatialEdge) {
  std::ostringstream text;
  text << std::setprecision(17)
       << "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n# STAMP 0 1\nVERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\n"
       << "# STAMP 1 2\nVERTEX_SE3:QUAT 2 1.1 2.2 3 " << -std::sin(0.2) << " 0 0 " << -std::cos(0.2)
       << "\n# STAMP 2 3\nEDGE_SE3:QUAT 0 2 1 2 3 0 0 0 1 9 2 0 0 0 0 4 0 0 0 0 1 0 0 0 25 0 0 1 0 1\n";
  std::istringstream graph(text.str());
  const auto closures = readClosures(graph, 0);
  ASSERT_EQ(closures.size(), 1u);
  EXPECT_NEAR(closures[0].off_m, std::hypot(0.1, 0.2), 1e-12);
  EXPECT_NEAR(closures[0].off_rad, 0.4, 1e-9);
  EXPECT_NEAR(closures[0].off_sigmas,
              std::sqrt(9 * 0.01 + 2 * 2 * 0.1 * 0.2 + 4 * 0.04 + 25 * std::pow(std::sin(0.2), 2)), 1e-9);
  EXPECT_EQ(closures[0].kind, "") << "the file does not tell";
}

// A wall of one cell stays when four cells become one.
TEST(ReportGrid, CoarserGridsKeepTheirWalls) {
  const TemporaryFolder folder;
  writeGrid(folder);
  const GridImage fine = readGridImage(folder.file("map.yaml")),
                  coarse = readGridImage(folder.file("map.yaml"), 3);
  EXPECT_EQ(fine.width, 4);
  EXPECT_EQ(coarse.width, 2);
  EXPECT_EQ(coarse.height, 2);
  EXPECT_EQ(coarse.cell_m, 1);
  EXPECT_EQ(coarse.y_min, -2);
  EXPECT_NE(coarse.png, fine.png);
}

}  // namespace
}  // namespace roomgraph::test
