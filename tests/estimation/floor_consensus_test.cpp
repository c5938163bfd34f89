// SPDX-License-Identifier: BSD-3-Clause
// Which of the planes below a handheld camera is believed to be the floor, and when.
#include "roomgraph/estimation/floor_consensus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace roomgraph::test {
namespace {

const Eigen::Vector3d kCamera(0.5, -0.2, 0);

/// A plane so far below the camera, tilted about y.
Plane below(double height_m, double tilt_rad = 0) {
  const Eigen::Vector3d normal(std::sin(tilt_rad), 0, std::cos(tilt_rad));
  return {normal, height_m - normal.dot(kCamera)};
}

/// When a plane that is seen every tenth of a second is believed; -1: not within `until_s`.
double believedAfter(FloorConsensus& floors, const Plane& plane, double from_s, double until_s) {
  for (double t = from_s; t < until_s; t += 0.1)
    if (floors.add(t, plane, kCamera)) return t - from_s;
  return -1;
}

TEST(FloorConsensus, SeveralFramesOfSomeTimeMustAgree) {
  FloorConsensus slow, fast;
  EXPECT_NEAR(believedAfter(slow, below(1.3), 0, 5), 0.2, 1e-9) << "three frames";
  int frames = 0;
  for (double t = 0; t < 1; t += 0.01) {
    ++frames;
    if (fast.add(t, below(1.3), kCamera)) break;
  }
  EXPECT_GT(frames, 20) << "a fast camera sees the same error often";
}

TEST(FloorConsensus, PlanesThatDisagreeAreNoFloor) {
  FloorConsensus tilted, uneven, forgotten;
  for (int i = 0; i < 50; ++i) {
    EXPECT_FALSE(tilted.add(0.1 * i, below(1.3, 0.1 * (i % 4)), kCamera).has_value() && i < 8) << i;
    EXPECT_FALSE(uneven.add(0.1 * i, below(1.0 + 0.1 * i), kCamera)) << i;
    EXPECT_FALSE(forgotten.add(6.0 * i, below(1.3), kCamera)) << i;
  }
}

TEST(FloorConsensus, IsTheMeanOfWhatAgrees) {
  std::mt19937 random{5};
  std::normal_distribution<double> tilt(0, 0.01), height(1.3, 0.01);
  FloorConsensus floors;
  floors.add(0, below(1.0, 0.3), kCamera);  // the front of a sofa
  std::optional<Plane> floor;
  for (int i = 1; i < 30; ++i) floor = floors.add(0.1 * i, below(height(random), tilt(random)), kCamera);
  ASSERT_TRUE(floor);
  EXPECT_NEAR(floor->normal.norm(), 1, 1e-12);
  EXPECT_LT(std::acos(floor->normal.z()), 0.006);
  EXPECT_NEAR(floor->distance(kCamera), 1.3, 0.006);
}

TEST(FloorConsensus, ATableIsNone) {
  FloorConsensus both;
  for (int i = 0; i < 3; ++i) both.add(0.02 * i, below(1.3), kCamera);  // the floor, in passing
  EXPECT_EQ(believedAfter(both, below(0.9), 0.1, 8), -1) << "something is below it";
  FloorConsensus near;
  EXPECT_NEAR(believedAfter(near, below(0.5), 0, 5), 3, 0.11) << "nothing else was seen for long";
}

TEST(FloorConsensus, OnlyWhatIsBelowOrTiltedContradictsAFloor) {
  const Eigen::Vector3d camera(0.5, -0.2, 1.3);
  const auto plane = [&](double height_m, double tilt_rad) {
    const Eigen::Vector3d normal(std::sin(tilt_rad), 0, std::cos(tilt_rad));
    return Plane{normal, height_m - normal.dot(camera)};
  };
  EXPECT_FALSE(contradictsFloor(plane(1.3, 0), camera)) << "the same";
  EXPECT_FALSE(contradictsFloor(plane(1.35, 0.03), camera)) << "noise";
  EXPECT_FALSE(contradictsFloor(plane(0.6, 0), camera)) << "a table";
  EXPECT_FALSE(contradictsFloor(plane(0.6, 0.3), camera)) << "a cushion";
  EXPECT_TRUE(contradictsFloor(plane(2.0, 0), camera)) << "world was levelled by a table";
  EXPECT_TRUE(contradictsFloor(plane(1.3, 0.15), camera)) << "world was levelled by a cushion";
}

}  // namespace
}  // namespace roomgraph::test
