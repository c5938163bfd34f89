// SPDX-License-Identifier: BSD-3-Clause
// Returns of slices in free space: in any frame of the tracker, tilted or not, and not behind its breaks.
#include "moving_in_depth.h"

#include <gtest/gtest.h>

namespace roomgraph {
namespace {

constexpr std::size_t kBeams = 101, kFirst = 45, kLast = 55;

RangeFan sliceAt(double t, bool with_somebody) {
  RangeFan slice{t, Pose3::Identity(), -0.5, 0.01, std::vector<float>(kBeams, -4.F)};  // the floor, as far as it is seen
  for (std::size_t i = kFirst; with_somebody && i <= kLast; ++i) slice.ranges_m[i] = 2;
  return slice;
}

/// After three seconds somebody stands 2 m ahead of a robot that drives by .1 m each second; the last slice may be of another segment.
RangeFan lastSlice(const Pose3& odom_from_first, int last_segment, int expected) {
  MovingInDepth moving;
  for (int i = 0; i < 30; ++i) {
    RangeFan free = sliceAt(0.1 * i, false);
    EXPECT_EQ(moving.leaveOut(free, odom_from_first * poseFromYpr(0.01 * i, 0, 0, 0, 0, 0), 0), 0);
  }
  RangeFan last = sliceAt(3, true);
  EXPECT_EQ(moving.leaveOut(last, odom_from_first * poseFromYpr(0.3, 0, 0, 0, 0, 0), last_segment), expected);
  return last;
}

TEST(MovingInDepth, InAnyFrameWhatStandsInFreeSpaceIsLeftOut) {
  for (const Pose3& odom_from_first : {Pose3(Pose3::Identity()), poseFromYpr(5, -3, 1, 0.7, 1.2, -0.4)}) {
    const RangeFan last = lastSlice(odom_from_first, 0, kLast - kFirst + 1);
    for (std::size_t i = 0; i < kBeams; ++i) EXPECT_EQ(last.ranges_m[i], i >= kFirst && i <= kLast ? 0 : -4) << i;
  }
}

TEST(MovingInDepth, BehindABreakNothingIsKnown) { EXPECT_EQ(lastSlice(Pose3::Identity(), 1, 0).ranges_m[kFirst], 2); }

}  // namespace
}  // namespace roomgraph
