// SPDX-License-Identifier: BSD-3-Clause
// LandmarkIdentity against labels that are rewritten at every merge.
#include "roomgraph/association/landmark_identity.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "random_poses.h"

namespace roomgraph::test {
namespace {

using Kind = IdentityChange::Kind;

TEST(LandmarkIdentity, MergesAreFollowedToTheEndInAnyOrder) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    LandmarkIdentity identity;
    std::vector<LandmarkId> label, alive;  // label[i]: today's id of id i
    for (int step = 0; step < 60; ++step) {
      if (alive.size() < 2 || random.uniform(0, 1) < 0.5) {
        const bool split = !alive.empty() && random.uniform(0, 1) < 0.3;
        label.push_back(split ? identity.split(alive.front()) : identity.create());
        ASSERT_EQ(label.back().value, static_cast<std::int64_t>(label.size()) - 1) << "no id twice";
        alive.push_back(label.back());
        continue;
      }
      const auto pick = [&] {
        return static_cast<std::size_t>(random.uniform(0, 1) * static_cast<double>(alive.size()) * 0.999);
      };
      const std::size_t i = pick(), j = pick();
      if (i == j) continue;
      const LandmarkId removed = alive[i], kept = alive[j];
      identity.merge(removed, kept);
      for (auto& id : label)
        if (id == removed) id = kept;
      std::erase(alive, removed);
    }
    for (std::size_t i = 0; i < label.size(); ++i)
      EXPECT_EQ(identity.today(LandmarkId{static_cast<std::int64_t>(i)}), label[i]) << "seed " << seed;
  }
}

TEST(LandmarkIdentity, ChangesAreInTheOrderInWhichTheyHappened) {
  LandmarkIdentity identity;
  identity.reserve(LandmarkId{4});
  const LandmarkId part = identity.split(LandmarkId{4});
  EXPECT_EQ(part, LandmarkId{5});
  identity.merge(LandmarkId{2}, part);
  ASSERT_EQ(identity.changes().size(), 2u);
  EXPECT_EQ(identity.changes()[0].kind, Kind::kSplit);
  EXPECT_EQ(identity.changes()[0].from, LandmarkId{4});
  EXPECT_EQ(identity.changes()[0].to, part);
  EXPECT_EQ(identity.changes()[1].kind, Kind::kMerge);
  EXPECT_EQ(identity.changes()[1].from, LandmarkId{2});
  EXPECT_EQ(identity.today(LandmarkId{2}), part);
  EXPECT_EQ(identity.today(LandmarkId{4}), LandmarkId{4}) << "a split landmark keeps its id";
  EXPECT_EQ(identity.today(LandmarkId{}), LandmarkId{});
}

TEST(LandmarkIdentity, OnlyTodaysLandmarksAreMerged) {
  LandmarkIdentity identity;
  identity.merge(LandmarkId{1}, LandmarkId{2});
  EXPECT_THROW(identity.merge(LandmarkId{1}, LandmarkId{3}), std::logic_error) << "merged before";
  EXPECT_THROW(identity.merge(LandmarkId{3}, LandmarkId{1}), std::logic_error) << "into one that is gone";
  EXPECT_THROW(identity.merge(LandmarkId{2}, LandmarkId{2}), std::logic_error);
  EXPECT_EQ(identity.changes().size(), 1u) << "what is refused leaves no trace";
}

TEST(LandmarkIdentity, RenamedWeightsAreAddedUp) {
  const WeightedLandmarks weights{
      {LandmarkId{3}, 0.25}, {LandmarkId{1}, 0.5}, {LandmarkId{2}, 0.125}, {{}, 0.125}};
  LandmarkIdentity identity;
  identity.merge(LandmarkId{3}, LandmarkId{2});
  const auto out = renamed(weights, [&](LandmarkId id) { return identity.today(id); });
  const WeightedLandmarks expected{{LandmarkId{2}, 0.375}, {LandmarkId{1}, 0.5}, {{}, 0.125}};
  EXPECT_EQ(out, expected);
  const auto all =
      renamed({{LandmarkId{1}, 0.7}, {LandmarkId{2}, 0.4}}, [](LandmarkId) { return LandmarkId{9}; });
  EXPECT_EQ(all, (WeightedLandmarks{{LandmarkId{9}, 1.0}})) << "no probability above 1";
}

}  // namespace
}  // namespace roomgraph::test
