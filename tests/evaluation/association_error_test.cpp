// SPDX-License-Identifier: BSD-3-Clause
// Association accuracy, identity switches and calibration against values worked out by hand.
#include "roomgraph/evaluation/association_error.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace roomgraph {
namespace {

constexpr const char* kChair = "swivel_chair";

// Object `id` stands at u = 100 * id in every frame.
Box2 place(int id) {
  return {100.0 * id, 0, 100.0 * id + 60, 60};
}

std::vector<TrueFrame> world(int frames) {
  std::vector<TrueFrame> out;
  for (int i = 0; i < frames; ++i)
    out.push_back({double(i),
                   {{1, kChair, kChair, place(1)},
                    {2, kChair, kChair, place(2)},
                    {3, "other", "green chair", place(3)},
                    {4, "other", "bin", place(4)}}});
  return out;
}

AssociatedBox seen(int object, int landmark, bool is_new = false, double probability = 1) {
  return {kChair, place(object), landmark, is_new, probability};
}
AssociatedBox founds(int object, int landmark, double probability = 1) {
  return seen(object, landmark, true, probability);
}

TEST(AssociationError, AllRight) {
  const auto errors = evaluateAssociations(world(3), {{0, {founds(1, 10), founds(2, 20)}},
                                                      {1, {seen(1, 10), seen(2, 20)}},
                                                      {2, {seen(2, 20), seen(1, 10)}}});
  EXPECT_EQ(errors.attributed, 6);
  EXPECT_EQ(errors.correct, 6);
  EXPECT_EQ(errors.accuracy, 1);
  EXPECT_EQ(errors.identity_switches, 0);
  EXPECT_EQ(errors.ece, 0);
  EXPECT_EQ(errors.objects, 2);
  EXPECT_EQ(errors.object_of_landmark, (std::map<int, int>{{10, 1}, {20, 2}}));
}

TEST(AssociationError, NamesOfLandmarksDoNotMatter) {
  const auto judge = [](int a, int b) {
    return evaluateAssociations(world(4), {{0, {founds(1, a)}},
                                           {1, {seen(1, a), founds(2, b)}},
                                           {2, {seen(1, b), seen(2, b)}},
                                           {3, {seen(1, a)}}});
  };
  for (const auto& errors : {judge(5, 7), judge(7, 5), judge(0, 1000)}) {
    EXPECT_EQ(errors.attributed, 6);
    EXPECT_EQ(errors.wrong_landmark, 1);  // object 1 went to the landmark of object 2 once …
    EXPECT_EQ(errors.correct, 5);
    EXPECT_EQ(errors.identity_switches, 2);  // … and came back
  }
}

TEST(AssociationError, PermutedLandmarksAreWrongOnce) {
  // From frame 3 on the two objects have exchanged their landmarks for good: of 5 sightings each landmark has
  // 3 of its first object, so the last 2 of each are wrong.
  std::vector<AssociatedFrame> frames = {{0, {founds(1, 10), founds(2, 20)}}};
  for (int i = 1; i < 3; ++i) frames.push_back({double(i), {seen(1, 10), seen(2, 20)}});
  for (int i = 3; i < 5; ++i) frames.push_back({double(i), {seen(1, 20), seen(2, 10)}});
  const auto errors = evaluateAssociations(world(5), frames);
  EXPECT_EQ(errors.wrong_landmark, 4);
  EXPECT_NEAR(errors.accuracy, 0.6, 1e-12);
  EXPECT_EQ(errors.identity_switches, 2);
}

TEST(AssociationError, NewIsRightOnlyForAnObjectWithoutLandmark) {
  const auto errors = evaluateAssociations(
      world(4),
      {{0, {founds(1, 10)}}, {1, {founds(1, 11)}}, {2, {seen(1, 11), founds(2, 20)}}, {3, {seen(1, 10)}}});
  EXPECT_EQ(errors.attributed, 5);
  EXPECT_EQ(errors.needless_new, 1);
  EXPECT_EQ(errors.wrong_landmark, 0) << "both landmarks are object 1's";
  EXPECT_EQ(errors.correct, 4);
  EXPECT_EQ(errors.identity_switches, 2) << "10 11 11 10";
  EXPECT_EQ(errors.object_of_landmark.size(), 3u);
}

TEST(AssociationError, NewIsRightWhenTheSightingsSoFarWentToAnothersLandmark) {
  const auto errors = evaluateAssociations(
      world(4), {{0, {founds(1, 10)}}, {1, {seen(1, 10)}}, {2, {seen(2, 10)}}, {3, {founds(2, 20)}}});
  EXPECT_EQ(errors.wrong_landmark, 1);
  EXPECT_EQ(errors.needless_new, 0);
  EXPECT_EQ(errors.correct, 3);
}

TEST(AssociationError, AllWrong) {
  // One landmark for both objects, met by object 1 first: every sighting of object 2 is wrong.
  const auto errors = evaluateAssociations(
      world(3),
      {{0, {founds(1, 10)}}, {1, {seen(2, 10, false, 1)}}, {2, {seen(2, 10, false, 1), seen(1, 10)}}});
  EXPECT_EQ(errors.object_of_landmark.at(10), 1) << "two each: the first met";
  EXPECT_EQ(errors.accuracy, 0.5);
  std::vector<AssociatedFrame> needless = {{0, {founds(1, 1)}}};
  for (int i = 1; i < 5; ++i) needless.push_back({double(i), {founds(1, 1 + i)}});
  const auto fragments = evaluateAssociations(world(5), needless);
  EXPECT_EQ(fragments.correct, 1);
  EXPECT_EQ(fragments.needless_new, 4);
  EXPECT_EQ(fragments.identity_switches, 4);
  EXPECT_NEAR(fragments.ece, 0.8, 1e-12) << "always sure, right once in five";
}

TEST(AssociationError, AttributionNeedsClassAndOverlap) {
  auto sofa = founds(1, 10);
  sofa.class_name = "sofa";
  auto beside = founds(1, 11);
  beside.box.u_min += 33;  // IoU 27 / 93 < .3
  beside.box.u_max += 33;
  auto near = founds(1, 12);
  near.box.u_min += 30;  // IoU 30 / 90
  near.box.u_max += 30;
  const auto errors = evaluateAssociations(
      world(1), {{0, {sofa, beside, near, founds(3, 13), founds(4, 14)}}, {9, {founds(2, 15)}}});
  EXPECT_EQ(errors.attributed, 2);
  EXPECT_EQ(errors.unattributed, 4) << "wrong class, too far, a bin, a frame without truth";
  EXPECT_EQ(errors.object_of_landmark, (std::map<int, int>{{12, 1}, {13, 3}}));
}

TEST(AssociationError, BestOverlapDecidesBetweenObjects) {
  std::vector<TrueFrame> truth = {
      {0, {{1, kChair, kChair, {0, 0, 60, 60}}, {2, kChair, kChair, {20, 0, 80, 60}}}}};
  AssociatedBox measured = founds(1, 10);
  measured.box = {15, 0, 75, 60};
  EXPECT_EQ(evaluateAssociations(truth, {{0, {measured}}}).object_of_landmark.at(10), 2);
}

TEST(AssociationError, TwoMeasurementsOfAnObjectInAFrameAreOneSighting) {
  auto loose = seen(1, 30);
  loose.box.u_max += 30;
  const auto errors =
      evaluateAssociations(world(3), {{0, {founds(1, 10)}}, {1, {loose, seen(1, 10)}}, {2, {seen(1, 10)}}});
  EXPECT_EQ(errors.identity_switches, 0);
  EXPECT_EQ(errors.attributed, 4);
}

TEST(AssociationError, ReliabilityTable) {
  // p = .55 twice, right once; p = .95 four times, right always; p = 1 in the last bin; one without
  // probability.
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const auto errors = evaluateAssociations(world(8), {{0, {founds(1, 10, 0.95)}},
                                                      {1, {founds(2, 20, unknown), seen(1, 10, false, 0.55)}},
                                                      {2, {seen(2, 10, false, 0.55)}},
                                                      {3, {seen(2, 20, false, 0.95)}},
                                                      {4, {seen(1, 10, false, 0.95)}},
                                                      {5, {seen(1, 10, false, 0.95)}},
                                                      {6, {seen(1, 10, false, 1)}}});
  EXPECT_EQ(errors.with_probability, 7);
  EXPECT_EQ(errors.attributed, 8);
  const auto& middle = errors.reliability[5];
  EXPECT_EQ(middle.count, 2);
  EXPECT_NEAR(middle.mean_probability, 0.55, 1e-12);
  EXPECT_NEAR(middle.correct_share, 0.5, 1e-12);
  const auto& sure = errors.reliability[9];
  EXPECT_EQ(sure.count, 5);
  EXPECT_NEAR(sure.mean_probability, 0.96, 1e-12);
  EXPECT_EQ(sure.correct_share, 1);
  EXPECT_EQ(errors.reliability[0].count, 0);
  EXPECT_NEAR(errors.ece, (2 * 0.05 + 5 * 0.04) / 7, 1e-12);
}

TEST(AssociationError, Empty) {
  for (const auto& errors : {evaluateAssociations({}, {}), evaluateAssociations(world(2), {}),
                             evaluateAssociations({}, {{0, {founds(1, 10)}}})}) {
    EXPECT_EQ(errors.attributed, 0);
    EXPECT_EQ(errors.accuracy, 0);
    EXPECT_EQ(errors.ece, 0);
    EXPECT_EQ(errors.identity_switches, 0);
  }
}

}  // namespace
}  // namespace roomgraph
