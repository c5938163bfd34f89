// SPDX-License-Identifier: BSD-3-Clause
// Landmarks of an earlier map after another session: ids, sums of evidence, what fades and what is new.
#include "roomgraph/estimation/landmark_continuation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace roomgraph::test {
namespace {

WeighedLandmark stool(std::int64_t id, double x, double existence) {
  WeighedLandmark out;
  out.landmark.id = LandmarkId{id};
  out.landmark.class_name = "chair";
  out.landmark.shape = {ShapeKind::kCylinder, 0.6, 0.6, 0.9};
  out.landmark.position = {x, 0, 0};
  out.landmark.covariance = 0.01 * Eigen::Matrix4d::Identity();
  out.landmark.existence = existence;
  out.landmark.class_posterior = {{"chair", 1}};
  out.landmark.observations = 10;
  out.weight = 5;
  return out;
}

TEST(LandmarkContinuation, EachIsMatchedOnceAndTheNearestFirst) {
  const std::vector<Landmark> earlier = {stool(1, 0, 1).landmark, stool(2, 3, 1).landmark,
                                         stool(4, 9, 1).landmark};
  const auto same =
      sameLandmarks({stool(7, 0.3, 1).landmark, stool(8, 0.1, 1).landmark, stool(9, 6, 1).landmark,
                     stool(4, 9, 1).landmark, stool(10, 9, 1).landmark},
                    earlier, {});
  EXPECT_EQ(same, (std::map<LandmarkId, LandmarkId>{{LandmarkId{8}, LandmarkId{1}}}))
      << "7 comes second, 9 is far, and what is 4 already leaves nothing to 10";
}

TEST(LandmarkContinuation, LooksAtAPlace) {
  EXPECT_EQ(logRatioOf({}), 0) << "nothing seen, nothing said";
  EXPECT_NEAR(logRatioOf({2, 0, 0, 0, 0}), -1.5, 1e-12);
  EXPECT_NEAR(logRatioOf({0, 1, 0, 0, 0}), -3, 1e-12) << "empty";
  EXPECT_NEAR(logRatioOf({0, 0.5, 0.4, 0, 0}), 1, 1e-12) << "half of it seen, something is there";
  EXPECT_NEAR(logRatioOf({100, 0, 0, 1, 0}), -3.75 - 3, 1e-12) << "misses are bounded; beams count, too";
}

TEST(LandmarkContinuation, EvidenceAddsUpAndIdsAreKept) {
  const auto both = continuedLandmarks({stool(1, 0, 0.8)}, {{}}, {stool(1, 0.2, 0.75)}, {LandmarkId{1}}, {});
  ASSERT_EQ(both.landmarks.size(), 1u);
  const auto& [landmark, weight] = both.landmarks[0];
  EXPECT_EQ(landmark.id.value, 1);
  EXPECT_NEAR(landmark.existence, 12.0 / 13, 1e-9);
  // What the earlier session said is 10 cm less sure now.
  EXPECT_NEAR(landmark.position.x(), 0.2 * 0.02 / 0.03, 1e-9);
  EXPECT_NEAR(landmark.covariance(0, 0), 0.02 * 0.01 / 0.03, 1e-9);
  EXPECT_EQ(landmark.observations, 20);
  EXPECT_EQ(weight, 10);
  EXPECT_EQ(both.seen_again, 1);
}

TEST(LandmarkContinuation, WhatWasMovedInThisRunStandsWhereItWasSeenLast) {
  WeighedLandmark now = stool(1, 0.2, 0.75);
  now.landmark.stands_since = 7;
  const auto both = continuedLandmarks({stool(1, 0, 0.8)}, {{}}, {now}, {LandmarkId{1}}, {});
  ASSERT_EQ(both.landmarks.size(), 1u);
  EXPECT_EQ(both.landmarks[0].landmark.position.x(), 0.2);
  EXPECT_EQ(both.landmarks[0].landmark.stands_since, 7);
  EXPECT_EQ(both.landmarks[0].landmark.observations, 20);
}

TEST(LandmarkContinuation, WhatWasMovedBetweenSessionsStandsWhereItIsNow) {
  const auto continued = [](WeighedLandmark then, WeighedLandmark now) {
    for (auto* one : {&then, &now}) one->landmark.covariance = 0.0004 * Eigen::Matrix4d::Identity();
    return continuedLandmarks({then}, {{}}, {now}, {LandmarkId{1}}, {}).landmarks.at(0).landmark;
  };
  EXPECT_EQ(continued(stool(1, 0, 0.9), stool(1, 0.8, 0.9)).position.x(), 0.8);
  EXPECT_NEAR(continued(stool(1, 0, 0.9), stool(1, 0.2, 0.9)).position.x(), 0.2, 0.02) << "may be the same place";
  EXPECT_NE(continued(stool(1, 0, 0.9), stool(1, 0.2, 0.9)).position.x(), 0.2);
  WeighedLandmark then = stool(1, 0, 0.9), now = stool(1, 0, 0.9);
  then.landmark.has_yaw = now.landmark.has_yaw = true;
  now.landmark.yaw = 1.5;
  EXPECT_EQ(continued(then, now).yaw, 1.5);
  now.landmark.yaw = 3.1;  // half a turn is none
  EXPECT_NEAR(std::abs(std::sin(continued(then, now).yaw)), 0, 0.05);
}

TEST(LandmarkContinuation, AGhostIsNoSighting) {
  WeighedLandmark sofa = stool(8, 0, 0.98), ghost = stool(1, 0.05, 0.03);
  sofa.landmark.class_name = "sofa";
  const auto both = continuedLandmarks({stool(1, 0, 0.97)}, {{}}, {sofa, ghost}, {LandmarkId{8}}, {});
  ASSERT_EQ(both.landmarks.size(), 1u);
  EXPECT_EQ(both.landmarks[0].landmark.class_name, "sofa");
  EXPECT_EQ(both.vanished, 1);
  EXPECT_EQ(both.seen_again, 0);
}

TEST(LandmarkContinuation, WhatIsSeenThroughFadesAndWhatIsNotSeenStays) {
  const PlaceLook gone{5, 1, 0, 0, 0};
  const auto both = continuedLandmarks({stool(1, 0, 0.99), stool(2, 3, 0.97), stool(3, 6, 0.9)},
                                       {gone, {}, {1, 0, 0, 0, 0}}, {stool(8, -4, 0.9)}, {LandmarkId{8}}, {});
  ASSERT_EQ(both.landmarks.size(), 3u);
  EXPECT_EQ(both.landmarks[0].landmark.id.value, 2);
  EXPECT_EQ(both.landmarks[0].landmark.existence, 0.97) << "unseen: as it was";
  EXPECT_NEAR(both.landmarks[1].landmark.existence, 1 / (1 + std::exp(0.75) / 9), 1e-9) << "missed once";
  EXPECT_EQ(both.landmarks[2].landmark.id.value, 8);
  EXPECT_EQ(both.vanished, 1);
  EXPECT_EQ(both.unseen, 2);
  EXPECT_EQ(both.appeared, 1);
}

TEST(LandmarkContinuation, WhatStandsInItsPlaceReplacesIt) {
  WeighedLandmark sofa = stool(8, 0, 0.9);
  sofa.landmark.class_name = "sofa";
  const auto both = continuedLandmarks({stool(1, 0, 0.99)}, {{}}, {sofa}, {LandmarkId{8}}, {});
  ASSERT_EQ(both.landmarks.size(), 1u);
  EXPECT_EQ(both.landmarks[0].landmark.id.value, 8);
}

TEST(LandmarkContinuation, AGlimpseDoesNotReplaceWhatNobodyLookedFor) {
  WeighedLandmark sofa = stool(1, 0, 0.99), chair = stool(8, 0, 0.9);
  sofa.weight = 200;
  chair.weight = 2;
  const PlaceLook in_vain{2, 0, 0, 0, 0};
  ASSERT_LT(logRatioOf(in_vain), 0);
  for (const auto& [look, expected] : {std::pair{PlaceLook{}, 1}, {in_vain, 8}}) {
    const auto both = continuedLandmarks({sofa}, {look}, {chair}, {LandmarkId{8}}, {});
    ASSERT_EQ(both.landmarks.size(), 1u);
    EXPECT_EQ(both.landmarks[0].landmark.id.value, expected);
  }
}

}  // namespace
}  // namespace roomgraph::test
