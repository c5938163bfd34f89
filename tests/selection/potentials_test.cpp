// SPDX-License-Identifier: BSD-3-Clause
// Carried areas against sampled surfaces, pairwise potential and shared features.
#include "potentials.h"

#include <gtest/gtest.h>

#include <set>

#include "made_up_room.h"

namespace roomgraph::test {
namespace {

Viewpoint viewOf(const FrameContext& context) {
  return {context.camera, context.world_from_camera};
}

Proposal onlyProposal(FrameContext& context, const RoomObject& object) {
  Random random(1);
  const FrameProposals frame = seenFrom(context, {object}, 1, 0, random);
  EXPECT_EQ(frame.proposals.size(), 1u);
  return frame.proposals.at(0);
}

Box2 areaSeen(FrameContext& context, const RoomObject& object) {
  return areaInImage(onlyProposal(context, object).projected, context.camera);
}

// Independent of projectShape: bounds of points all over the model's surface, seen by the second camera.
Box2 boundsOfSamples(const RoomObject& object, const Viewpoint& view) {
  Box2 box{1e9, 1e9, -1e9, -1e9};
  const auto base = footprint(object.shape, 2000);
  for (const double z : {0.0, object.shape.height})
    for (const auto& corner : base) {
      const Eigen::Vector3d in_world = object.world_from_object * Eigen::Vector3d(corner.x(), corner.y(), z);
      const Eigen::Vector2d pixel = view.camera.project(view.world_from_camera.inverse() * in_world);
      box = {std::min(box.u_min, pixel.x()), std::min(box.v_min, pixel.y()), std::max(box.u_max, pixel.x()),
             std::max(box.v_max, pixel.y())};
    }
  return box;
}

TEST(CarriedArea, IsWhereTheObjectIsSeenAfterTheCameraMoved) {
  Random random(5);
  int cut = 0;
  for (int round = 0; round < 200; ++round) {
    const double x = random.uniform(2.5, 4), y = random.uniform(-0.8, 0.8);
    const RoomObject object = round % 2 ? chairAt(x, y) : sofaAt(x, y, random.uniform(-3, 3));
    FrameContext before = viewFrom(0, 0, 0);
    FrameContext now =
        viewFrom(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.4, 0.4));
    const auto carried =
        carriedArea(shapeInWorld(onlyProposal(before, object), before.world_from_camera), viewOf(now));
    const Box2 expected = boundsOfSamples(object, viewOf(now));
    ASSERT_EQ(carried.has_value(), !clipped(expected, 640, 480).empty());
    if (!carried) continue;
    EXPECT_NEAR(carried->full.u_min, expected.u_min, 0.1);
    EXPECT_NEAR(carried->full.v_min, expected.v_min, 0.1);
    EXPECT_NEAR(carried->full.u_max, expected.u_max, 0.1);
    EXPECT_NEAR(carried->full.v_max, expected.v_max, 0.1);
    const Box2 visible = clipped(expected, 640, 480);
    cut += visible.area() < expected.area();
    EXPECT_GT(iou(carried->visible, visible), 0.99);
    // Seen again at the same place: nothing to pay.
    EXPECT_NEAR(pairwisePotential(areaSeen(now, object), carried), 0, 1e-9);
  }
  EXPECT_GT(cut, 10);
}

TEST(CarriedArea, IsNothingOutsideTheImageAndBehind) {
  FrameContext before = viewFrom(0, 0, 0);
  const auto placed = shapeInWorld(onlyProposal(before, chairAt(3, 0)), before.world_from_camera);
  for (const double yaw : {1.2, -1.2, 3.1}) EXPECT_FALSE(carriedArea(placed, viewOf(viewFrom(0, 0, yaw))));
  EXPECT_EQ(pairwisePotential(areaSeen(before, chairAt(3, 0)), std::nullopt), 1);
}

TEST(PairwisePotential, IsOneLessTheOverlap) {
  const Box2 a{0, 0, 20, 10};
  ProjectedShape b;
  b.visible = {10, 0, 30, 10};
  EXPECT_DOUBLE_EQ(pairwisePotential(a, b), 1 - 100.0 / 300);
  b.visible = {20, 0, 30, 10};
  EXPECT_EQ(pairwisePotential(a, b), 1);
}

// A chair moved by its diameter does not overlap with itself; the pairwise term grows on the way there.
TEST(PairwisePotential, GrowsWithTheDistanceOfTwoProposals) {
  FrameContext before = viewFrom(0, 0, 0), now = viewFrom(0.1, 0.1, 0.1);
  const auto carried =
      carriedArea(shapeInWorld(onlyProposal(before, chairAt(3, 0)), before.world_from_camera), viewOf(now));
  double last = -1;
  for (const double y : {0.0, 0.1, 0.2, 0.4, 0.6}) {
    const double potential = pairwisePotential(areaSeen(now, chairAt(3, y)), carried);
    EXPECT_GT(potential, last);
    last = potential;
  }
  EXPECT_GT(last, 0.9);
}

// Where a table hides the lower half, a chair keeps its area: two depths with one visible part stay apart.
TEST(PairwisePotential, IsOfTheWholeAreaAlsoWhereTheObjectIsHidden) {
  FrameContext context = viewFrom(0, 0, 0);
  Proposal hidden = onlyProposal(context, chairAt(3, 0));
  const Box2 whole = hidden.projected.visible;
  hidden.projected.visible.v_max = hidden.projected.visible.center().y();
  EXPECT_EQ(areaInImage(hidden.projected, context.camera), whole);
  const Box2 cut = areaSeen(context, chairAt(1, 0));
  EXPECT_EQ(cut.v_max, 480) << "the image's border does cut it";
  const auto carried = carriedArea(shapeInWorld(hidden, context.world_from_camera), viewOf(context));
  EXPECT_NEAR(pairwisePotential(areaInImage(hidden.projected, context.camera), carried), 0, 1e-9);
  EXPECT_GT(pairwisePotential(areaSeen(context, chairAt(2, 0)), carried), 0.4);
}

TEST(FeatureShare, AgreesWithSets) {
  EXPECT_EQ(featureShare({}, {}), 0);
  EXPECT_EQ(featureShare({1, 2}, {}), 0);
  EXPECT_EQ(featureShare({1, 2, 3}, {2, 3, 4}), 0.5);
  Random random(6);
  for (int round = 0; round < 100; ++round) {
    std::set<std::int64_t> a, b, either;
    for (int i = 0; i < 20; ++i) (random.index(2) ? a : b).insert(random.index(15));
    int both = 0;
    for (const auto id : a) both += static_cast<int>(b.count(id));
    either.insert(a.begin(), a.end());
    either.insert(b.begin(), b.end());
    EXPECT_DOUBLE_EQ(featureShare({a.begin(), a.end()}, {b.begin(), b.end()}),
                     static_cast<double>(both) / static_cast<double>(either.size()));
  }
}

TEST(Features, AreThoseInsideTheBoxWithAPoint) {
  std::vector<FeatureTrack> features = {{{5, 5}, 9}, {{15, 5}, 3}, {{25, 5}, 1}, {{15, 6}, 2}, {{15, 7}, -1}};
  features.push_back(features[1]);
  EXPECT_EQ(featuresInside(features, {10, 0, 20, 10}), (std::vector<std::int64_t>{2, 3}));
  EXPECT_TRUE(featuresInside({}, {10, 0, 20, 10}).empty());
}

TEST(Features, OnTheObjectHaveItsDepth) {
  FrameContext context = viewFrom(0, 0, 0);
  const Proposal chair = onlyProposal(context, chairAt(3, 0));
  const Box2 box = chair.projected.visible;
  const Eigen::Vector2d middle = box.center();
  // Front of the chair at 2.69 m, back at 3.31 m.
  const std::vector<FeatureTrack> features = {{middle, 1, 2.7}, {middle, 2, 3.3}, {middle, 3, 2.6},
                                              {middle, 4, 1.5}, {middle, 5, 4.5}, {middle, 6, 0},
                                              {{1, 1}, 7, 0},   {{1, 1}, 8, 3.0}, {middle, -1, 3.0}};
  EXPECT_EQ(featuresOnObject(features, box, chair, context.camera, 0.15),
            (std::vector<std::int64_t>{1, 2, 3, 6}));
  EXPECT_EQ(featuresOnObject(features, box, chair, context.camera, 0.01),
            (std::vector<std::int64_t>{1, 2, 6}));
}

TEST(Features, OfTheMadeUpRoomLieOnTheirObjects) {
  Random random(3);
  FrameContext context = viewFrom(0, 0, 0);
  const FrameProposals frame = seenFrom(context, {chairAt(3, 0.6), chairAt(3, -0.6)}, 1, 0, random);
  ASSERT_EQ(frame.proposals.size(), 2u);
  for (int k = 0; k < 2; ++k) {
    const auto ids = featuresOnObject(context.features, frame.detections[static_cast<std::size_t>(k)].box,
                                      frame.proposals[static_cast<std::size_t>(k)], context.camera, 0.15);
    ASSERT_EQ(ids.size(), 12u);
    for (const auto id : ids) EXPECT_EQ(id / 100, k);
  }
}

}  // namespace
}  // namespace roomgraph::test
