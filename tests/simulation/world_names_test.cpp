// SPDX-License-Identifier: BSD-3-Clause
// Words of world files and rounded numbers, against those written out here.
#include "world_names.h"

#include <gmock/gmock.h>

#include "json_numbers.h"

namespace roomgraph {
namespace {

using ::testing::ElementsAre;

TEST(WorldNames, AreThoseOfTheFormat) {
  EXPECT_THAT(allWords(kSideWords), ElementsAre("north", "east", "south", "west"));
  EXPECT_THAT(allWords(kDoorWords), ElementsAre("none", "closed", "half_open", "open"));
  EXPECT_EQ(valueOf(kSideWords, "south"), Side::kSouth);
  EXPECT_EQ(valueOf(kDoorWords, "half_open"), DoorState::kHalfOpen);
  EXPECT_EQ(wordOf(kSideWords, Side::kWest), "west");
  EXPECT_EQ(wordOf(kDoorWords, DoorState::kClosed), "closed");
}

TEST(JsonNumbers, AreRoundedToTheNearestStep) {
  EXPECT_EQ(roundedTo(0.12345, 1e4), 0.1235);
  EXPECT_EQ(roundedTo(-2.00004, 1e4), -2);
  EXPECT_EQ(numbersJson(Eigen::Vector3d(1, -0.5, 1.0 / 3), 1e4).dump(), "[1.0,-0.5,0.3333]");
}

}  // namespace
}  // namespace roomgraph
