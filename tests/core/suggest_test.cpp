// SPDX-License-Identifier: BSD-3-Clause
// Spelling suggestions and joining of lists.
#include "roomgraph/core/suggest.h"

#include <gtest/gtest.h>

namespace roomgraph {
namespace {

const std::vector<std::string> kKeys = {"max_range_m", "min_range_m", "enabled"};

TEST(Suggest, FindsMisspellings) {
  EXPECT_EQ(closestMatch("max_rang_m", kKeys), "max_range_m");
  EXPECT_EQ(closestMatch("enabeld", kKeys), "enabled");
  EXPECT_EQ(closestMatch("min_range", kKeys), "min_range_m");
  EXPECT_EQ(didYouMean("enable", kKeys), " (did you mean 'enabled'?)");
}

TEST(Suggest, FindsKeysByTheirNameWithoutUnit) {
  EXPECT_EQ(closestMatch("tilt", {"title", "tilt_rad"}), "tilt_rad");
  EXPECT_EQ(closestMatch("tilt", {"tilt_of_the_camera_rad"}), "") << "more than a unit";
  EXPECT_EQ(closestMatch("tilt", {"tiltedge"}), "") << "no unit";
}

TEST(Suggest, SaysNothingAboutOtherWords) {
  EXPECT_EQ(closestMatch("colour", kKeys), "");
  EXPECT_EQ(didYouMean("colour", kKeys), "");
  EXPECT_EQ(closestMatch("anything", {}), "");
}

TEST(Suggest, FirstOfEquallyNearWins) {
  EXPECT_EQ(closestMatch("ax", {"ab", "ac"}), "ab");
}

TEST(Suggest, Join) {
  EXPECT_EQ(join({}), "");
  EXPECT_EQ(join({"a"}), "a");
  EXPECT_EQ(join({"a", "b"}, "; "), "a; b");
}

}  // namespace
}  // namespace roomgraph
