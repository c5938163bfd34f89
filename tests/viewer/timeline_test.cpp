// SPDX-License-Identifier: BSD-3-Clause
// Timeline: what is shown while states come, after seeking, and after thinning; sightings of merged
// landmarks.
#include "roomgraph/viewer/timeline.h"

#include <gtest/gtest.h>

#include "made_up_states.h"

namespace roomgraph::test {
namespace {

TEST(Timeline, FollowsTheNewestStateUntilSomebodyGoesBack) {
  Timeline timeline;
  EXPECT_TRUE(timeline.empty());
  EXPECT_TRUE(timeline.atEnd());
  timeline.add(statesFromTo(1, 5));
  EXPECT_EQ(timeline.shown().record, 5);
  timeline.add(statesFromTo(6, 7));
  EXPECT_EQ(timeline.shown().record, 7);
  timeline.move(-2);
  EXPECT_EQ(timeline.shown().record, 5);
  EXPECT_FALSE(timeline.atEnd());
  timeline.add(statesFromTo(8, 9));
  EXPECT_EQ(timeline.shown().record, 5) << "what comes does not take away what somebody looks at";
  EXPECT_EQ(timeline.newest().record, 9);
  timeline.move(100);
  EXPECT_TRUE(timeline.atEnd());
  timeline.add(statesFromTo(10, 10));
  EXPECT_EQ(timeline.shown().record, 10);
  timeline.move(-100);
  EXPECT_EQ(timeline.shown().record, 1);
}

TEST(Timeline, SeeksTheLastStateThatIsNotLater) {
  Timeline timeline;
  ViewStates states = statesFromTo(3, 5);
  states.push_back(stateAt(9));
  timeline.add(states);
  const std::pair<int, int> expected[] = {{-4, 3}, {2, 3}, {3, 3}, {4, 4}, {5, 5}, {8, 5}, {9, 9}, {99, 9}};
  for (const auto& [asked, shown] : expected) {
    timeline.seekRecord(asked);
    EXPECT_EQ(timeline.shown().record, shown) << asked;
    timeline.move(1);
    timeline.seekTime(kBegin_t + asked + 0.5);
    EXPECT_EQ(timeline.shown().record, shown) << asked + 0.5 << " s";
  }
  timeline.seekTime(kBegin_t + 4);
  EXPECT_EQ(timeline.shown().record, 4) << "the state of that very time";
  EXPECT_EQ(timeline.shownPointer(), states[1]);
}

TEST(Timeline, OfTooManyStatesOldOnesWithoutSightingsGo) {
  Timeline timeline(20);
  ViewStates states = statesFromTo(1, 20);
  for (const int record : {4, 5, 6}) {
    auto seen = stateAt(record);
    seen->sightings = {sightingAt(1, record)};
    states[static_cast<std::size_t>(record) - 1] = seen;
  }
  timeline.add(states);
  EXPECT_EQ(timeline.states().size(), 20u);
  timeline.seekRecord(8);
  timeline.add(statesFromTo(21, 21));
  EXPECT_EQ(timeline.shown().record, 8) << "not the one that somebody looks at";
  EXPECT_LE(timeline.states().size(), 18u);
  EXPECT_EQ(timeline.newest().record, 21);
  EXPECT_EQ(timeline.sightingsOf(LandmarkId{1}).size(), 3u);
  int newer = 0;
  for (const auto& state : timeline.states()) newer += state->record > 11;
  EXPECT_EQ(newer, 10) << "the newer half is whole";
}

TEST(Timeline, SightingsAreThoseUntilTheMomentUnderAllIdsOfTheLandmark) {
  LandmarkIdentity identity;
  for (int i = 0; i < 4; ++i) identity.create();
  Timeline timeline;
  for (int record = 1; record <= 6; ++record) {
    auto state = stateAt(record);
    state->sightings = {sightingAt(record % 2 ? 1 : 3, record), sightingAt(2, record)};
    if (record == 4) identity.merge(LandmarkId{3}, LandmarkId{1});
    state->identity = std::make_shared<const LandmarkIdentity>(identity);
    timeline.add({state});
  }
  EXPECT_EQ(timeline.sightingsOf(LandmarkId{1}).size(), 6u);
  EXPECT_EQ(timeline.sightingsOf(LandmarkId{2}).size(), 6u);
  EXPECT_TRUE(timeline.sightingsOf(LandmarkId{3}).empty()) << "it is landmark 1 now";
  timeline.seekRecord(3);
  EXPECT_EQ(timeline.sightingsOf(LandmarkId{1}).size(), 2u) << "records 1 and 3";
  EXPECT_EQ(timeline.sightingsOf(LandmarkId{3}).size(), 1u) << "it was one of its own then";
}

TEST(Timeline, WithHindsightTheSightingsAreThoseOfTheWholeRun) {
  const auto all = std::make_shared<const std::vector<ShownSighting>>(
      std::vector{sightingAt(1, 1), sightingAt(2, 2), sightingAt(1, 3)});
  Timeline timeline;
  for (int record = 1; record <= 3; ++record) {
    auto state = stateAt(record);
    state->sightings = {sightingAt(5, record)};
    state->all_sightings = all;
    timeline.add({state});
  }
  EXPECT_EQ(timeline.sightingsOf(LandmarkId{1}).size(), 2u);
  EXPECT_TRUE(timeline.sightingsOf(LandmarkId{5}).empty());
  timeline.seekRecord(2);
  EXPECT_EQ(timeline.sightingsOf(LandmarkId{1}).size(), 1u) << "not what is later than the moment";
}

TEST(ViewState, TheLandmarkOfAnId) {
  auto state = stateAt(1);
  EXPECT_EQ(findLandmark(*state, LandmarkId{2}), nullptr);
  state->landmarks = std::make_shared<const ShownLandmarks>(
      ShownLandmarks{shownLandmark(sampleLandmark(1, "sofa", ShapeKind::kCuboid, 0, 0)),
                     shownLandmark(sampleLandmark(2, "door", ShapeKind::kPlanar, 1, 0))});
  EXPECT_EQ(findLandmark(*state, LandmarkId{2})->landmark.class_name, "door");
  EXPECT_EQ(findLandmark(*state, LandmarkId{7}), nullptr);
  state->landmarks = nullptr;
  EXPECT_EQ(findLandmark(*state, LandmarkId{2}), nullptr);
}

TEST(ViewState, ThePathUntilAMoment) {
  ShownPath path;
  for (int i = 0; i < 5; ++i)
    path.push_back(toShown({kBegin_t + i, poseFromYpr(i, 2 * i, 0.5, 0.3 * i, 0, 0)}));
  EXPECT_TRUE(pathUntil(path, kBegin_t - 1).empty());
  EXPECT_EQ(pathUntil(path, kBegin_t + 9).size(), 5u);
  const auto some = pathUntil(path, kBegin_t + 3);
  ASSERT_EQ(some.size(), 4u);
  EXPECT_DOUBLE_EQ(some.back().t, kBegin_t + 3);
  EXPECT_LT((some.back().pose.translation() - Eigen::Vector3d(3, 6, 0.5)).norm(), 1e-6);
  EXPECT_NEAR(planarPart(some.back().pose).yaw, 0.9, 1e-6);
}

}  // namespace
}  // namespace roomgraph::test
