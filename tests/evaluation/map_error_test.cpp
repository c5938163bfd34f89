// SPDX-License-Identifier: BSD-3-Clause
// Map errors against drawn maps and all-pairs distances.
#include "roomgraph/evaluation/map_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "random_poses.h"

namespace roomgraph {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using test::Random;

// A map as drawn: '#' occupied, '.' free, ' ' unknown; the first line has the largest y.
COccupancyGridMap2D drawn(const std::vector<std::string>& lines, float resolution = 0.1f, float x_min = 0,
                          float y_min = 0) {
  const auto width = static_cast<float>(lines.front().size()), height = static_cast<float>(lines.size());
  COccupancyGridMap2D grid;
  grid.setSize(x_min, x_min + width * resolution, y_min, y_min + height * resolution, resolution);
  for (std::size_t row = 0; row < lines.size(); ++row)
    for (std::size_t x = 0; x < lines[row].size(); ++x) {
      const char c = lines[row][x];
      grid.setCell(static_cast<int>(x), static_cast<int>(lines.size() - 1 - row),
                   c == '#'   ? 0.f
                   : c == '.' ? 1.f
                              : 0.5f);
    }
  return grid;
}

const std::vector<std::string> kRoom = {"########", "#......#", "#......#", "#......#", "########"};

TEST(MapError, PerfectMap) {
  const auto errors = evaluateMap(drawn(kRoom), drawn(kRoom));
  EXPECT_EQ(errors.estimated_occupied, 22);
  EXPECT_EQ(errors.precision, 1);
  EXPECT_EQ(errors.recall, 1);
  EXPECT_EQ(errors.f1, 1);
  EXPECT_EQ(errors.known_in_both, 40);
  EXPECT_EQ(errors.agreement, 1);
  EXPECT_EQ(errors.free_agreement, 1);
  EXPECT_EQ(errors.unknown_share, 0);
  EXPECT_EQ(errors.to_truth_m.max, 0);
  EXPECT_EQ(errors.to_map_m.max, 0);
}

TEST(MapError, HandComputedWithToleranceAndUnknown) {
  const auto truth = drawn({"#.......",  //
                            "#.......",  //
                            "#......."});
  const auto map = drawn({".#...  .",  // one cell off: within the tolerance
                          "#....  #",  // right, and a wall that is not there
                          " .....  "});
  const auto errors = evaluateMap(truth, map);
  EXPECT_EQ(errors.checked_occupied, 3);
  EXPECT_EQ(errors.correct_occupied, 2);
  EXPECT_EQ(errors.expected_occupied, 2) << "the third true one is unknown to the map";
  EXPECT_EQ(errors.found_occupied, 2);
  EXPECT_NEAR(errors.precision, 2.0 / 3, 1e-12);
  EXPECT_EQ(errors.recall, 1);
  EXPECT_NEAR(errors.f1, 0.8, 1e-12);
  EXPECT_EQ(errors.known_in_both, 17);
  EXPECT_NEAR(errors.unknown_share, 7.0 / 24, 1e-12);
  // Exact states: (0,0), (1,0) and (7,1) differ.
  EXPECT_NEAR(errors.agreement, 14.0 / 17, 1e-12);
  EXPECT_NEAR(errors.free_agreement, 13.0 / 15, 1e-12);
  EXPECT_NEAR(errors.free_precision, 13.0 / 14, 1e-12);
  EXPECT_NEAR(errors.to_truth_m.mean, (0.1 + 0 + 0.7) / 3, 1e-6);
  EXPECT_NEAR(errors.to_truth_m.median, 0.1, 1e-6);
  EXPECT_NEAR(errors.to_truth_m.p95, 0.7, 1e-6);
  EXPECT_NEAR(errors.to_map_m.mean, (0.1 + 0 + 0.1) / 3, 1e-6)
      << "top: from (0, 0) down to (0, 1) or right to (1, 0)";
  MapOptions exact;
  exact.tolerance_cells = 0;
  EXPECT_EQ(evaluateMap(truth, map, exact).correct_occupied, 1);
}

TEST(MapError, ToleranceReachesTheDiagonalNeighbourOnly) {
  const auto truth = drawn({"#...", "....", "...."});
  EXPECT_EQ(evaluateMap(truth, drawn({"....", ".#..", "...."})).precision, 1);
  EXPECT_EQ(evaluateMap(truth, drawn({"..#.", "....", "...."})).precision, 0);
  EXPECT_EQ(evaluateMap(truth, drawn({"....", "..#.", "...."})).precision, 0);
}

TEST(MapError, AllWrong) {
  const auto errors = evaluateMap(drawn({"##......", "##......"}), drawn({".....###", ".....###"}));
  EXPECT_EQ(errors.precision, 0);
  EXPECT_EQ(errors.recall, 0);
  EXPECT_EQ(errors.f1, 0);
  EXPECT_NEAR(errors.agreement, 6.0 / 16, 1e-12);
  EXPECT_NEAR(errors.to_truth_m.mean, 0.5, 1e-6);
  EXPECT_NEAR(errors.to_map_m.mean, 0.45, 1e-6);
}

TEST(MapError, NothingKnownAndNothingInCommon) {
  const auto truth = drawn(kRoom);
  const auto blank = evaluateMap(truth, drawn({"   ", "   "}));
  EXPECT_EQ(blank.known_in_both, 0);
  EXPECT_EQ(blank.unknown_share, 1);
  EXPECT_EQ(blank.to_truth_m.count, 0);
  EXPECT_EQ(blank.to_map_m.count, 0) << "there is nothing to be near to";
  const auto elsewhere = evaluateMap(truth, drawn(kRoom, 0.1f, 50, 50));
  EXPECT_EQ(elsewhere.known_in_both, 0);
  EXPECT_EQ(elsewhere.checked_occupied, 0);
  EXPECT_GT(elsewhere.to_truth_m.mean, 60);
  const auto open = evaluateMap(drawn({"...."}), drawn({"...."}));
  EXPECT_EQ(open.agreement, 1);
  EXPECT_EQ(open.precision, 0);
  EXPECT_EQ(open.checked_occupied, 0);
}

TEST(MapError, OriginsMayDiffer) {
  // The same wall at x = .4 .. .5 m, drawn in a larger and in a smaller grid.
  const auto truth = drawn({"......", "....#.", "....#."});
  const auto errors = evaluateMap(truth, drawn({".#", ".#"}, 0.1f, 0.3f, 0));
  EXPECT_EQ(errors.known_in_both, 4);
  EXPECT_EQ(errors.agreement, 1);
  EXPECT_EQ(errors.recall, 1);
  EXPECT_NEAR(errors.unknown_share, 14.0 / 18, 1e-12);
  EXPECT_NEAR(errors.to_truth_m.max, 0, 1e-6);
}

TEST(MapError, ResolutionsMayDiffer) {
  const auto fine = drawn({"..##", "..##"}, 0.1f);
  const auto coarse = drawn({".#"}, 0.2f);
  const auto errors = evaluateMap(fine, coarse);
  EXPECT_EQ(errors.known_in_both, 2);
  EXPECT_EQ(errors.agreement, 1);
  EXPECT_EQ(errors.precision, 1);
  EXPECT_EQ(errors.expected_occupied, 4);
  EXPECT_EQ(errors.recall, 1);
  EXPECT_NEAR(errors.to_truth_m.mean, std::sqrt(0.005), 1e-6)
      << "centre of the coarse cell to that of a fine one";
  EXPECT_EQ(evaluateMap(coarse, fine).agreement, 1);
}

TEST(MapError, MovedAndTurnedMapIsBroughtBack) {
  const auto truth = drawn({"#..",  //
                            "#..",  //
                            "#..",  //
                            "###"});
  // The same room turned a quarter to the left: the left wall is at the bottom, the bottom wall at the right.
  const auto turned = drawn({"...#",  //
                             "...#",  //
                             "####"});
  MapOptions options;
  // The turned map's corner (0, 0) is the truth's corner (0, .4); its x axis points down.
  options.truth_from_map = Pose2{0, 0.4, -M_PI / 2};
  const auto errors = evaluateMap(truth, turned, options);
  EXPECT_EQ(errors.known_in_both, 12);
  EXPECT_EQ(errors.agreement, 1);
  EXPECT_NEAR(errors.to_truth_m.max, 0, 1e-6);
  EXPECT_NEAR(errors.to_map_m.max, 0, 1e-6);
  EXPECT_LT(evaluateMap(truth, turned).agreement, 1) << "as it is, it does not fit";
  MapOptions back;
  back.truth_from_map = options.truth_from_map.inverse();
  EXPECT_EQ(evaluateMap(turned, truth, back).agreement, 1);
}

TEST(MapError, DistancesEqualAllPairsSearch) {
  Random random(5);
  for (int round = 0; round < 10; ++round) {
    const auto scribble = [&](std::size_t width, std::size_t height) {
      std::vector<std::string> lines(height, std::string(width, '.'));
      for (auto& line : lines)
        for (auto& c : line) c = random.uniform(0, 1) < 0.1 ? '#' : random.uniform(0, 1) < 0.2 ? ' ' : '.';
      lines[0][0] = '#';
      return lines;
    };
    const auto truth = drawn(scribble(23, 17), 0.05f), map = drawn(scribble(12, 14), 0.08f, 0.08f, -0.16f);
    MapOptions options;
    options.truth_from_map =
        Pose2{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-3, 3)};
    const auto places = [](const COccupancyGridMap2D& grid, const Pose2& pose) {
      std::vector<Eigen::Vector2d> out;
      for (int x = 0; x < static_cast<int>(grid.getSizeX()); ++x)
        for (int y = 0; y < static_cast<int>(grid.getSizeY()); ++y)
          if (grid.getCell(x, y) < 0.3f)
            out.push_back(pose * Eigen::Vector2d(double(grid.idx2x(x)), double(grid.idx2y(y))));
      return out;
    };
    const auto true_places = places(truth, {}), map_places = places(map, options.truth_from_map);
    double sum = 0, largest = 0;
    for (const auto& p : map_places) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& q : true_places) nearest = std::min(nearest, (p - q).norm());
      sum += nearest;
      largest = std::max(largest, nearest);
    }
    const auto errors = evaluateMap(truth, map, options);
    ASSERT_EQ(errors.to_truth_m.count, static_cast<int>(map_places.size()));
    EXPECT_NEAR(errors.to_truth_m.mean, sum / static_cast<double>(map_places.size()), 1e-5);
    EXPECT_NEAR(errors.to_truth_m.max, largest, 1e-5);
  }
}

}  // namespace
}  // namespace roomgraph
