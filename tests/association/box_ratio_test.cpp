// SPDX-License-Identifier: BSD-3-Clause
// MeasurementModel::boxRatio against hand-computed side densities and sampled silhouettes.
#include <gtest/gtest.h>

#include <cmath>

#include "sightings.h"
#include "soft_associator.h"

namespace roomgraph::test {
namespace {

constexpr double kFocal = 500, kCenter = 320, kRow = 240, kHeight_m = 0.8;

// A camera .8 m above the origin that looks along world x.
Pose3 worldFromCamera() {
  Pose3 pose = Pose3::Identity();
  pose.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  pose.translation() = Eigen::Vector3d(0, 0, kHeight_m);
  return pose;
}

Landmark cylinderAt(std::int64_t id, double x, double y) {
  Landmark landmark = landmarkAt(id, x, y);
  landmark.shape = {ShapeKind::kCylinder, 0.6, 0.6, 0.9};
  return landmark;
}

// Bounds of densely sampled rims, pinhole by hand.
Box2 silhouette(double x, double y) {
  Box2 box{1e9, 1e9, -1e9, -1e9};
  for (int k = 0; k < 20000; ++k) {
    const double angle = 2 * M_PI * k / 20000;
    for (const double z : {0.0, 0.9}) {
      const double ahead = x + 0.3 * std::cos(angle), left = y + 0.3 * std::sin(angle);
      const double u = kCenter - kFocal * left / ahead, v = kRow + kFocal * (kHeight_m - z) / ahead;
      box = {std::min(box.u_min, u), std::min(box.v_min, v), std::max(box.u_max, u), std::max(box.v_max, v)};
    }
  }
  return box;
}

WorldMeasurement chairSeenAt(double x, double y, const Box2& box) {
  WorldMeasurement seen = sightingAt(x, y);
  seen.measurement.proposal.shape = {ShapeKind::kCylinder, 0.6, 0.6, 0.9};
  seen.measurement.proposal.camera_from_object = worldFromCamera().inverse() * seen.world_from_object;
  seen.measurement.detection.box = box;
  seen.camera = {.width = 640, .height = 480, .fx = kFocal, .fy = kFocal, .cx = kCenter, .cy = kRow};
  return seen;
}

double side(double gap, double size, const MeasurementModel& model) {
  const double z = gap / size / model.box_sigma;
  return (1 - model.hidden_side) * std::exp(-z * z / 2) / model.box_sigma / std::sqrt(2 * M_PI) +
         model.hidden_side / 2;
}

TEST(BoxRatio, IsOneForTheProposalsOwnPlace) {
  const MeasurementModel model;
  const WorldMeasurement seen = chairSeenAt(3, 0.4, {200, 150, 300, 380});
  EXPECT_NEAR(model.boxRatio(seen, cylinderAt(1, 3, 0.4)), 1, 1e-9);
}

TEST(BoxRatio, ComparesTheFourSidesWithTheProjectedLandmark) {
  const MeasurementModel model;
  const Box2 box = silhouette(3, 0.4), other = silhouette(4, 0.1);
  const WorldMeasurement seen = chairSeenAt(3, 0.4, box);
  const double expected = side(other.u_min - box.u_min, box.width(), model) *
                          side(other.u_max - box.u_max, box.width(), model) *
                          side(other.v_min - box.v_min, box.height(), model) *
                          side(other.v_max - box.v_max, box.height(), model) / std::pow(side(0, 1, model), 4);
  EXPECT_NEAR(model.boxRatio(seen, cylinderAt(1, 4, 0.1)), expected, 0.02 * expected);
  EXPECT_LT(expected, 0.1);
}

TEST(BoxRatio, LeavesOutSidesOnTheImageBorder) {
  const MeasurementModel model;
  Box2 box = silhouette(2, 1.2);
  ASSERT_LT(box.u_min, 0);
  box.u_min = 0;
  const Box2 other = silhouette(2, 1.1);
  ASSERT_LT(other.u_min, 0);
  const double expected = side(other.u_max - box.u_max, box.width(), model) / side(0, 1, model) *
                          side(other.v_max - box.v_max, box.height(), model) / side(0, 1, model) *
                          side(other.v_min - box.v_min, box.height(), model) / side(0, 1, model);
  EXPECT_NEAR(model.boxRatio(chairSeenAt(2, 1.2, box), cylinderAt(1, 2, 1.1)), expected, 0.02 * expected);
}

TEST(BoxRatio, SaysNothingWithoutACamera) {
  WorldMeasurement seen = chairSeenAt(3, 0, silhouette(3, 0));
  seen.camera = {};
  EXPECT_EQ(MeasurementModel{}.boxRatio(seen, cylinderAt(1, 5, 1)), 1);
  EXPECT_FALSE(MeasurementModel{}.ownBox(seen));
}

TEST(BoxRatio, IsByTheOwnBoxThatIsKnownBefore) {
  const MeasurementModel model;
  const WorldMeasurement seen = chairSeenAt(3, 0.4, {200, 150, 300, 380});
  const Landmark chair = cylinderAt(1, 4, 0.1);
  const OwnBox own = model.ownBox(seen);
  ASSERT_TRUE(own);
  EXPECT_EQ(model.boxRatio(seen, chair, own), model.boxRatio(seen, chair));
  EXPECT_DOUBLE_EQ(model.boxRatio(seen, chair, 3 * *own), model.boxRatio(seen, chair) / 3);
  EXPECT_EQ(model.density(seen, chair, own), model.density(seen, chair));
}

TEST(BoxRatio, ALandmarkBehindTheCameraIsHardlySeen) {
  const WorldMeasurement seen = chairSeenAt(3, 0, silhouette(3, 0));
  const double ratio = MeasurementModel{}.boxRatio(seen, cylinderAt(1, -3, 0));
  EXPECT_GT(ratio, 0);
  EXPECT_LT(ratio, 1e-3);
}

// Two chairs behind each other on one ray; the depth is that of something in front of both.
TEST(BoxRatio, TellsWhichChairABoxWithAFailedDepthShows) {
  const auto chosen = [](double x) {
    SoftAssociator associator;
    WorldMeasurement seen = chairSeenAt(2.2, 0, silhouette(x, 0));
    seen.measurement.proposal.score = 0.1;
    seen.covariance *= 0.05;
    const std::vector<Landmark> landmarks{cylinderAt(1, 3.2, 0), cylinderAt(2, 5.5, 0)};
    return associator.associate({seen}, landmarks)[0].landmark;
  };
  EXPECT_EQ(chosen(3.2), LandmarkId{1});
  EXPECT_EQ(chosen(5.5), LandmarkId{2});
}

}  // namespace
}  // namespace roomgraph::test
