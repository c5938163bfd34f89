// SPDX-License-Identifier: BSD-3-Clause
// Sides of boxes on and off the image border.
#include "roomgraph/geometry/box_sides.h"

#include <gtest/gtest.h>

namespace roomgraph {
namespace {

TEST(BoxSides, SidesOnTheImageBorderAreNotInside) {
  const PinholeCamera camera{.width = 640, .height = 480, .fx = 400, .fy = 300, .cx = 320, .cy = 240};
  EXPECT_EQ(sidesInside({0, 100, 639.5, 200}, camera), (BoxSides{false, true, false, true}));
  EXPECT_EQ(sidesInside({5, 1, 600, 479}, camera), (BoxSides{true, false, true, false}));
  EXPECT_EQ(sidesInside({4, 4, 636, 476}, camera), (BoxSides{true, true, true, true}));
  EXPECT_EQ(sidesInside({3, 3, 637, 477}, camera), (BoxSides{})) << "the border itself belongs to the border";
  EXPECT_EQ(sidesInside({5, 1, 600, 479}, camera).inOrder(), (std::array<bool, 4>{true, false, true, false}));
}

}  // namespace
}  // namespace roomgraph
