// SPDX-License-Identifier: BSD-3-Clause
// Branch-and-bound search against brute force.
#include "correlative_search.h"

#include <gtest/gtest.h>

#include <random>

#include "synthetic_scans.h"

namespace roomgraph {
namespace {

/// Mean probability at the points by looking at the finest level only.
double scoreAt(const ScorePyramid& pyramid, const Points2& points, const Pose2& pose) {
  double sum = 0;
  for (const Eigen::Vector2d& p : transformed(pose, points)) {
    const Eigen::Vector2d cell = (p - pyramid.corner()) / pyramid.cellSize();
    sum +=
        pyramid.at(0, static_cast<int>(std::floor(cell.x())), static_cast<int>(std::floor(cell.y()))) / 255.0;
  }
  return sum / static_cast<double>(points.size());
}

class CorrelativeSearch : public ::testing::Test {
 protected:
  CorrelativeSearch() : random_(17), grid_(0.1) {
    const Scan scan = test::castScan(test::asymmetricRoom(), {}, 0, random_);
    grid_.insert(toPlanarScan(scan, 0.1, 30), {}, {0.7, 0.4});
    pyramid_ = ScorePyramid(grid_, 4);
    points_ = thinnedTo(
        toPlanarScan(test::castScan(test::asymmetricRoom(), truth_, 0, random_), 0.1, 30).points, 0.05,
        60);
  }
  std::mt19937 random_;
  const Pose2 truth_{0.35, -0.25, 0.2};
  ProbabilityGrid grid_;
  ScorePyramid pyramid_;
  Points2 points_;
};

TEST_F(CorrelativeSearch, EqualsBruteForce) {
  for (const double penalty : {0.0, 0.4}) {
    const SearchWindow window{0.6, 0.3, penalty, penalty, 0};
    const auto found = correlativeSearch(pyramid_, points_, {}, window);
    ASSERT_TRUE(found);
    double farthest = 1;
    for (const Eigen::Vector2d& p : points_) farthest = std::max(farthest, p.norm());
    const int angles = static_cast<int>(std::ceil(0.3 * farthest / 0.1 - 1e-9));
    double best = 0;
    for (int a = -angles; a <= angles; ++a)
      for (int x = -6; x <= 6; ++x)
        for (int y = -6; y <= 6; ++y) {
          const Pose2 pose{0.1 * x, 0.1 * y, a * 0.3 / angles};
          best = std::max(best, scoreAt(pyramid_, points_, pose) -
                                    penalty * (pose.x * pose.x + pose.y * pose.y + pose.yaw * pose.yaw));
        }
    EXPECT_NEAR(found->score, best, 0.006);
  }
}

TEST_F(CorrelativeSearch, FindsTheMovement) {
  const auto found = correlativeSearch(pyramid_, points_, {}, {1.0, 0.5, 0, 0, 0.2});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->grid_from_scan.x, truth_.x, 0.1);
  EXPECT_NEAR(found->grid_from_scan.y, truth_.y, 0.1);
  EXPECT_NEAR(found->grid_from_scan.yaw, truth_.yaw, 0.03);
}

TEST_F(CorrelativeSearch, NothingAboveAnUnreachableScore) {
  EXPECT_FALSE(correlativeSearch(pyramid_, points_, {}, {1.0, 0.5, 0, 0, 0.99}));
  EXPECT_FALSE(correlativeSearch(pyramid_, {}, {}, {1.0, 0.5, 0, 0, 0}));
}

TEST_F(CorrelativeSearch, ExcludedPoseIsNotReturned) {
  const SearchWindow window{1.0, 0.5, 0, 0, 0};
  const auto best = correlativeSearch(pyramid_, points_, {}, window);
  const auto second =
      correlativeSearch(pyramid_, points_, {}, window, ExcludedPose{best->grid_from_scan, 0.5, 0.3});
  ASSERT_TRUE(second);
  EXPECT_LT(second->score, best->score);
  const double shift = std::hypot(second->grid_from_scan.x - best->grid_from_scan.x,
                                  second->grid_from_scan.y - best->grid_from_scan.y);
  EXPECT_TRUE(shift >= 0.5 || std::abs(second->grid_from_scan.yaw - best->grid_from_scan.yaw) >= 0.3);
}

}  // namespace
}  // namespace roomgraph
