// SPDX-License-Identifier: BSD-3-Clause
// Typed ids: validity, type safety, ordering, printing and hashing.
#include "roomgraph/core/ids.h"

#include <gtest/gtest.h>

#include <sstream>
#include <type_traits>
#include <unordered_set>

namespace roomgraph {
namespace {

TEST(Ids, DefaultIsNone) {
  EXPECT_FALSE(FrameId{}.valid());
  EXPECT_TRUE(FrameId{0}.valid());
}

TEST(Ids, KindsCannotBeMixed) {
  EXPECT_FALSE((std::is_convertible_v<FrameId, LandmarkId>));
  EXPECT_FALSE((std::is_convertible_v<FrameId, std::int64_t>));
}

TEST(Ids, OrderedPrintableHashable) {
  EXPECT_LT(NodeId{1}, NodeId{2});
  EXPECT_EQ(NodeId{3}, NodeId{3});
  std::ostringstream text;
  text << LandmarkId{42};
  EXPECT_EQ(text.str(), "42");
  const std::unordered_set<TrackId> set = {TrackId{1}, TrackId{1}, TrackId{2}};
  EXPECT_EQ(set.size(), 2u);
}

}  // namespace
}  // namespace roomgraph
