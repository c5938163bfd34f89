// SPDX-License-Identifier: BSD-3-Clause
// Fit and quality of placed shapes: closed forms, and what single kinds of evidence decide.
#include "roomgraph/proposals/shape_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cuboid_generator.h"
#include "cylinder_generator.h"
#include "scene.h"

namespace roomgraph {
namespace {

using std::numbers::pi;
using test::Scene;

BoxEvidence fitEvidence(const Scene& scene, const ObjectModel& model, bool with_depth) {
  cv::Mat labels;
  Frame frame = scene.render(&labels);
  const Detection detection = test::detectionOf(1, labels, model.class_name);
  if (!with_depth) frame.depth = cv::Mat();
  return gatherEvidence(frame, detection, model, groundInCamera(scene.world_from_camera));
}

TEST(Quality, FallsWithTheDistanceOfPointsOutside) {
  Scene scene = test::sceneAhead();
  scene.addCylinder(2.5, 0, 0.31, 0.95, 1);
  BoxEvidence e = fitEvidence(scene, *test::database().find("swivel_chair"), true);
  PlacedShape chair = usualShape(e);
  chair.x = 2.5;
  const auto with = [&](std::vector<double> ranges) {  // of points straight ahead, half a metre above the ground
    e.mask.points.clear();
    for (const double range : ranges) e.mask.points.push_back({0, 0, {range, 0, 0.5}});
    judge(chair, e);
    return chair.quality / chair.box_iou;
  };
  const double front = 2.5 - chair.shape.radius();
  EXPECT_NEAR(with({2.5, front}), 1, 1e-9) << "inside and on the surface";
  EXPECT_NEAR(with({front - 0.1, front - 0.1}), std::exp(-0.1 / 0.15), 1e-9);
  EXPECT_NEAR(with({front - 0.1, 2.5}), std::exp(-0.05 / 0.15), 1e-9);
  EXPECT_NEAR(with({front - 2}), std::exp(-0.3 / 0.15), 1e-9) << "levels off";
}

// Neither the box's sides nor the direction of the start count: only the points can turn the cuboid.
TEST(Fit, PointsAloneTurnACuboid) {
  const ObjectDatabase database = ObjectDatabase::fromText(
      "[crate]\nlabels = crate\nwidth_m = 1.2\ndepth_m = 0.8\nheight_m = 0.6\nwidth_sigma_m = 0.02\n"
      "depth_sigma_m = 0.02\nheight_sigma_m = 0.02\n");
  FitWeights weights;
  weights.box_side_px = 1e4;
  weights.yaw_sigma_rad = 1e3;
  weights.all_points = 400;
  for (const double turn : {0.4, -0.6}) {
    Scene scene = test::sceneAhead();
    scene.addBox(2.4, 0.1, pi + turn, 1.2, 0.8, 0, 0.6, 1);
    const BoxEvidence e = fitEvidence(scene, *database.find("crate"), true);
    for (const double wrong : {-0.2, 0.2}) {
      PlacedShape start = usualShape(e);
      start.x = 2.4;
      start.y = 0.1;
      start.yaw = pi + turn + wrong;
      EXPECT_LT(std::abs(wrapAngle(fitShape(start, e, weights).yaw - pi - turn)), 0.06) << turn << " " << wrong;
    }
  }
}

// Only the lower part of a tall cabinet is in the image: a side of the box at the border is reached or passed.
TEST(Fit, AModelMayReachBeyondTheBorderOfTheImage) {
  const ObjectDatabase database = ObjectDatabase::fromText(
      "[post]\nlabels = post\nshape = cylinder\nwidth_m = 0.4\ndepth_m = 0.4\nheight_m = 2\nheight_sigma_m = 0.5\n");
  Scene scene;
  scene.lookAhead(0.9, 0.25);
  scene.addCylinder(2.5, 0, 0.2, 2, 1);
  const BoxEvidence e = fitEvidence(scene, *database.find("post"), true);
  ASSERT_TRUE(e.cut.top && !e.cut.bottom);
  const auto found = test::hypotheses<CylinderGenerator>(e);
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(found[0].shape.height, 2, 0.1) << "nothing speaks against the usual height";
}

// The leg was seen; the box is wider on one side than the chair.
TEST(Fit, TheLegHoldsTheAxis) {
  Scene scene;
  scene.lookAhead(0.8, 0.2);
  scene.addCylinder(2.5, 0.3, 0.31, 0.95, 1);
  BoxEvidence e = fitEvidence(scene, *test::database().find("swivel_chair"), false);
  const double leg = e.camera.project((scene.world_from_camera.inverse() * Eigen::Vector3d(2.5, 0.3, 0))).x();
  e.box.u_max += 0.3 * e.box.width();
  e.segments = {{{leg, e.box.v_max - 40}, {leg, e.box.v_max - 8}}};
  const auto columnOf = [&](const PlacedShape& p) {
    return e.camera.project(cameraFromObject(p, e).translation()).x();
  };
  GeneratorLimits all;
  all.max_count = 10;
  int from_leg = 0;
  for (const PlacedShape& p : CylinderGenerator().generate(e, all)) {
    if (p.source != "leg line") continue;
    ++from_leg;
    PlacedShape free = p;
    free.leg_column.reset();
    EXPECT_LT(std::abs(columnOf(p) - leg), std::abs(columnOf(fitShape(free, e)) - leg) - 1);
  }
  EXPECT_GT(from_leg, 0);
}

// A width taken out of the compromise with the usual one is near that of a fit to which the usual one means
// nothing.
TEST(Fit, SizeInformationIsThatOfTheImageAlone) {
  const auto crate = [](double width_sigma) {
    return ObjectDatabase::fromText(
        "[crate]\nlabels = crate\nwidth_m = 1.2\ndepth_m = 0.8\nheight_m = 0.6\ndepth_sigma_m = 0.05\n"
        "height_sigma_m = 0.05\nwidth_sigma_m = " +
        std::to_string(width_sigma) + "\n");
  };
  for (const double width : {1.05, 1.3, 1.5}) {
    Scene scene = test::sceneAhead();
    scene.addBox(2.4, 0.1, pi, width, 0.8, 0, 0.6, 1);
    const auto fit = [&](const ObjectDatabase& database) {
      const BoxEvidence e = fitEvidence(scene, *database.find("crate"), true);
      PlacedShape start = usualShape(e);
      start.x = 2.4, start.yaw = pi, start.has_yaw = true;
      return fitShape(start, e);
    };
    const double sigma = 0.08, prior = 1 / (sigma * sigma);
    const PlacedShape held = fit(crate(sigma)), free = fit(crate(10));
    ASSERT_NEAR(free.shape.width, width, 0.05);
    const double information = held.size_information[0], pull = std::abs(free.shape.width - held.shape.width);
    ASSERT_GT(pull, 0.01) << "the usual size pulls";
    const double measured = ((information + prior) * held.shape.width - prior * 1.2) / information;
    // Depth points push outwards only: those outside a shape that is held too narrow say more than they
    // should.
    EXPECT_LT(std::abs(measured - free.shape.width), 0.6 * pull) << width;
    EXPECT_LT(std::abs(std::log(free.size_information[0] / information)), std::log(4)) << width;
  }
}

// The place moves with a size that is only believed: fits with another usual width say by how much.
TEST(Fit, PlaceBySizeIsTheChangeOfThePlaceWithTheUsualSize) {
  const auto crate = [](double width) {
    return ObjectDatabase::fromText(
        "[crate]\nlabels = crate\ndepth_m = 0.8\nheight_m = 0.6\ndepth_sigma_m = 0.05\nheight_sigma_m = "
        "0.05\n"
        "width_sigma_m = 0.02\nwidth_m = " +
        std::to_string(width) + "\n");
  };
  for (const bool cut : {false, true}) {
    Scene scene = test::sceneAhead();
    scene.addBox(2.4, cut ? -1.2 : 0, pi, 1.3, 0.8, 0, 0.6, 1);
    const auto fit = [&](const ObjectDatabase& database) {
      const BoxEvidence e = fitEvidence(scene, *database.find("crate"), true);
      EXPECT_EQ(e.cut.right, cut);
      PlacedShape start = usualShape(e);
      start.x = 2.4, start.y = cut ? -1.2 : 0, start.yaw = pi, start.has_yaw = true;
      return fitShape(start, e);
    };
    const PlacedShape narrow = fit(crate(1.28)), wide = fit(crate(1.32));
    const double grown = wide.shape.width - narrow.shape.width;
    ASSERT_GT(grown, cut ? 0.03 : 0.01);
    // In the crate's frame left is where y falls in the ground's.
    EXPECT_NEAR((narrow.y - wide.y) / grown, narrow.place_by_size(1, 0), 0.1) << cut;
    EXPECT_NEAR(narrow.place_by_size(1, 0), cut ? 0.5 : 0, 0.15) << "the left side in the image stays";
  }
}

// A crate of 2.6 m goes on beyond the image, 1.6 m of it are in view: it is longer than usual, or nothing is said.
TEST(Fit, APartTellsTheLeastLengthWhereItIsLongerThanUsual) {
  Scene scene = test::sceneAhead();
  scene.addBox(2.4, -0.9, pi, 2.6, 0.8, 0, 0.6, 1);
  for (const bool usually_short : {true, false}) {
    const ObjectDatabase database = ObjectDatabase::fromText(
        "[crate]\nlabels = crate\ndepth_m = 0.8\nheight_m = 0.6\ndepth_sigma_m = 0.05\nheight_sigma_m = 0.05\n"
        "width_sigma_m = 0.3\nwidth_m = " +
        std::string(usually_short ? "1.2\n" : "2.4\n"));
    const BoxEvidence e = fitEvidence(scene, *database.find("crate"), true);
    ASSERT_TRUE(e.cut.right);
    PlacedShape start = usualShape(e);
    start.x = 2.4, start.y = 0.4 - start.shape.width / 2, start.yaw = pi, start.has_yaw = true;
    const PlacedShape fitted = fitShape(start, e);
    EXPECT_NEAR(fitted.y + fitted.shape.width / 2, 0.4, 0.05) << "the end in view";
    EXPECT_EQ(fitted.size_information[0], 0) << "the length is not measured";
    if (usually_short) {
      EXPECT_GT(fitted.shape.width, 1.45);
      EXPECT_GT(fitted.least_size_information[0], 1 / (0.3 * 0.3)) << "surer than the class";
    } else {
      EXPECT_EQ(fitted.least_size_information[0], 0);
    }
  }
}

// Only the foot end of a bed is seen, at the height of the camera: the rest lies behind it.
TEST(Cuboid, WhatIsNotSeenLiesBehindWhatIs) {
  const ObjectDatabase database = ObjectDatabase::fromText(
      "[bed]\nlabels = bed\nwidth_m = 1.6\ndepth_m = 2\nheight_m = 0.5\nwidth_sigma_m = 0.1\ndepth_sigma_m = 0.1\n");
  Scene scene;
  scene.lookAhead(0.45, 0);
  scene.addBox(3.6, 0.1, pi, 1.6, 2, 0, 0.5, 1);
  const auto found = test::hypotheses<CuboidGenerator>(fitEvidence(scene, *database.find("bed"), true));
  ASSERT_FALSE(found.empty());
  EXPECT_LT(std::hypot(found[0].x - 3.6, found[0].y - 0.1), 0.2);
  EXPECT_NEAR(found[0].shape.width, 1.6, 0.1);
  EXPECT_NEAR(found[0].shape.depth, 2, 0.1);
}

}  // namespace
}  // namespace roomgraph
