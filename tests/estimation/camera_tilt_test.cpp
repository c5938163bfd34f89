// SPDX-License-Identifier: BSD-3-Clause
// Floors that cameras on robots see: medians of planes with outliers, and what says nothing.
#include "roomgraph/estimation/camera_tilt.h"

#include <gtest/gtest.h>

#include "roomgraph/core/random.h"

namespace roomgraph::test {
namespace {

const Eigen::Vector3d kCamera(0.1, 0.05, 1.1);

// By a recorded pose that pitches the camera too much; the floor seems `lower_m` lower.
std::optional<Plane> floorSeen(double pitch, double lower_m = 0) {
  const Eigen::Vector3d up = poseFromYpr(0, 0, 0, 0, pitch, 0).linear() * Eigen::Vector3d::UnitZ();
  return Plane{up, kCamera.z() + lower_m - up.dot(kCamera)};
}

void see(CameraTilt& tilt, int t, const std::optional<Plane>& floor) { tilt.add(t, {0.2 * t, 0, 0}, floor, kCamera); }

TEST(CameraTilt, IsTheMedianOfWhatMostImagesSee) {
  Random random(2);
  CameraTilt tilt;
  for (int t = 0; t < 40; ++t) see(tilt, t, t % 4 == 0 ? floorSeen(0.3, 0.05) : floorSeen(0.12 + 0.003 * random.normal(), 0.01 * random.normal()));
  const auto up = tilt.up();
  ASSERT_TRUE(up);
  EXPECT_LT((*up - floorSeen(0.12)->normal).norm(), 0.005);
}

TEST(CameraTilt, FewImagesOrFewThatShowItOrOthersEachTimeSayNothing) {
  CameraTilt few, seldom, often, swaying, riding, table, wall;
  for (int t = 0; t < 9; ++t) see(few, t, floorSeen(0.1));
  EXPECT_FALSE(few.up());
  see(few, 9, floorSeen(0.1));
  EXPECT_TRUE(few.up());
  for (int t = 0; t < 40; ++t) {
    see(seldom, t, t % 2 == 0 ? floorSeen(0.1) : std::nullopt);
    see(often, t, t % 3 != 0 ? floorSeen(0.1) : std::nullopt);
    see(swaying, t, floorSeen(0.1 * (t % 3)));
    see(riding, t, floorSeen(0.1, 0.06 * (t % 3)));
    see(table, t, floorSeen(0.1, -0.3));
    see(wall, t, floorSeen(0.5));
  }
  EXPECT_FALSE(seldom.up());
  EXPECT_TRUE(often.up());
  EXPECT_FALSE(swaying.up());
  EXPECT_FALSE(riding.up());
  EXPECT_FALSE(table.up());
  EXPECT_FALSE(wall.up());
}

TEST(CameraTilt, LooksOnceASecondWhileItDrivesAndAHundredTimes) {
  CameraTilt tilt, standing, turning;
  int looked = 0;
  for (int i = 0; i < 3000; ++i)
    if (const Pose2 place{0.02 * i, 0, 0}; tilt.wants(5 + 0.1 * i, place)) {
      tilt.add(5 + 0.1 * i, place, std::nullopt, kCamera);
      ++looked;
    }
  EXPECT_EQ(looked, 100);
  standing.add(0, {1, 1, 3.1}, std::nullopt, kCamera);
  EXPECT_FALSE(standing.wants(0.9, {2, 1, 3.1}));
  EXPECT_TRUE(standing.wants(1, {2, 1, 3.1}));
  EXPECT_FALSE(standing.wants(60, {1.05, 1, 3.1}));
  EXPECT_TRUE(standing.wants(60, {1, 1, -3.05})) << "turned by .13 rad";
}

}  // namespace
}  // namespace roomgraph::test
