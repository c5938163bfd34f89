// SPDX-License-Identifier: BSD-3-Clause
// Landmarks from boxes of known poses: against rays, information filters and known objects.
#include "box_insertion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "roomgraph/geometry/projection.h"
#include "sample_map.h"

namespace roomgraph {
namespace {

const PinholeCamera kFineCamera{640, 480, 525, 525, 319.5, 239.5, {}};

ObjectModel chairModel() {
  ObjectModel model;
  model.class_name = "swivel_chair";
  model.shape = "cylinder";
  model.width_m = model.depth_m = 0.6;
  model.height_m = 0.9;
  return model;
}

Pose3 fineCameraAt(double x, double y, double yaw) {
  Pose3 pose = poseFromYpr(x, y, 0.8, yaw, 0.25, 0);
  pose.linear() = pose.linear() * bodyFromOptical();
  return pose;
}

std::optional<Landmark> placed(const Box2& box, const Pose3& camera) {
  return placedByBox(box, chairModel(), kFineCamera, camera, MapLikelihoodOptions());
}

Box2 boxOf(double x, double y, const Pose3& camera) {
  return projectShape(chairModel().nominal(), camera.inverse() * poseFromYpr(x, y, 0, 0, 0, 0), kFineCamera)
      ->visible;
}

TEST(BoxInsertion, ObjectsStandWhereTheirBoxesEnd) {
  for (const auto& [x, y] : {std::pair{2.0, 0.1}, {3.0, -0.6}, {3.5, 0.8}}) {
    const Pose3 camera = fineCameraAt(0.2, 0.1, 0.05);
    const auto landmark = placed(boxOf(x, y, camera), camera);
    ASSERT_TRUE(landmark) << x;
    EXPECT_NEAR(landmark->position.x(), x, 0.08);  // the middle of a box is not quite that of the object
    EXPECT_NEAR(landmark->position.y(), y, 0.08);
    EXPECT_EQ(landmark->position.z(), 0);
    EXPECT_EQ(landmark->class_name, "swivel_chair");
    EXPECT_FALSE(landmark->has_yaw);
  }
}

// The place for a bottom line moved by one standard deviation, and for a camera tilted by one.
TEST(BoxInsertion, CovarianceIsThatOfFiniteDifferences) {
  const Pose3 camera = fineCameraAt(0, 0, 0);
  const Box2 box = boxOf(3, 0, camera);
  const auto landmark = placed(box, camera);
  ASSERT_TRUE(landmark);
  const MapLikelihoodOptions noise;
  Box2 lower = box, aside = box;
  const double sigma_v = std::hypot(noise.side_sigma_px, noise.box_sigma * box.height());
  const double sigma_u = std::hypot(noise.side_sigma_px, noise.box_sigma * box.width());
  lower.v_max += 0.1 * sigma_v;
  aside.u_min += 0.1 * sigma_u;
  aside.u_max += 0.1 * sigma_u;
  Pose3 tilted = poseFromYpr(0, 0, 0.8, 0, 0.25 + 0.001, 0);
  tilted.linear() = tilted.linear() * bodyFromOptical();
  const double by_row = 10 * (placed(lower, camera)->position - landmark->position).x();
  const double by_tilt = 10 * (placed(box, tilted)->position - landmark->position).x();
  const double by_column = 10 * (placed(aside, camera)->position - landmark->position).y();
  EXPECT_NEAR(std::sqrt(landmark->covariance(0, 0)) / std::hypot(by_row, by_tilt), 1, 0.15);
  EXPECT_NEAR(std::sqrt(landmark->covariance(1, 1)) / std::abs(by_column), 1, 0.15);
  EXPECT_NEAR(landmark->covariance(0, 1), 0, 1e-3);
}

TEST(BoxInsertion, NothingIsPlacedByHalfABox) {
  const Pose3 camera = fineCameraAt(0, 0, 0);
  const Box2 whole = boxOf(3, 0, camera);
  EXPECT_TRUE(placed(whole, camera));
  EXPECT_FALSE(placed({0, whole.v_min, whole.u_max, whole.v_max}, camera)) << "cut at the left";
  EXPECT_FALSE(placed({whole.u_min, whole.v_min, 640, whole.v_max}, camera)) << "cut at the right";
  EXPECT_FALSE(placed({whole.u_min, whole.v_min, whole.u_max, 480}, camera)) << "its feet are not seen";
  EXPECT_FALSE(placed({300, 20, 340, 60}, camera)) << "ends above the horizon";
  EXPECT_FALSE(placed({300, 90, 340, 118}, camera)) << "farther than far_m";
  ObjectModel lamp = chairModel();
  lamp.rests_on_ground = false;
  EXPECT_FALSE(placedByBox(whole, lamp, kFineCamera, camera, MapLikelihoodOptions()));
}

// A sequence of sightings gives the mean weighted by information, and its covariance.
TEST(BoxInsertion, FilterIsTheInformationMean) {
  std::vector<Landmark> landmarks;
  const MapInsertionOptions options;
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d weighted = Eigen::Vector2d::Zero();
  for (int i = 0; i < 6; ++i) {
    Landmark sighting = test::sampleLandmark(-1, "sofa", ShapeKind::kCuboid, 3 + 0.05 * i, 1 - 0.03 * i);
    Eigen::Matrix2d root;
    root << 0.1 + 0.02 * i, 0, 0.05, 0.2 - 0.02 * i;
    sighting.covariance.topLeftCorner<2, 2>() = root * root.transpose();
    const Eigen::Matrix2d inverse = (root * root.transpose()).inverse();
    information += inverse;
    weighted += inverse * sighting.position.head<2>();
    EXPECT_EQ(insertSighting(sighting, 0.8, options, landmarks)->value, 0);
  }
  ASSERT_EQ(landmarks.size(), 1U);
  const Eigen::Vector2d mean = information.inverse() * weighted;
  EXPECT_LT((landmarks[0].position.head<2>() - mean).norm(), 1e-9);
  EXPECT_LT((landmarks[0].covariance.topLeftCorner(2, 2) - information.inverse()).norm(), 1e-9);
  EXPECT_EQ(landmarks[0].observations, 6);
  const double one = 1 / (1 + std::exp(-5 * (0.8 - 0.2)));
  EXPECT_NEAR(one, 0.9526, 1e-4);
  EXPECT_EQ(landmarks[0].existence, 0.99) << "no sum of boxes makes it certain";
}

TEST(BoxInsertion, FarAndOtherObjectsAreNewOnes) {
  std::vector<Landmark> landmarks;
  const MapInsertionOptions options;
  const auto insert = [&](const std::string& name, double x, double score) {
    Landmark sighting = test::sampleLandmark(-1, name, ShapeKind::kCuboid, x, 0);
    sighting.covariance = Eigen::Matrix4d::Identity() * 0.01;
    return insertSighting(sighting, score, options, landmarks);
  };
  EXPECT_EQ(insert("sofa", 1, 0.9)->value, 0);
  EXPECT_NEAR(landmarks[0].existence, 1 / (1 + std::exp(-3.5)), 1e-9) << "Bayes' rule from even odds";
  EXPECT_EQ(insert("sofa", 1.4, 0.9)->value, 0) << "2.8 of the two deviations of .1 m away";
  EXPECT_EQ(insert("sofa", 2.5, 0.9)->value, 1);
  EXPECT_EQ(insert("door", 1, 0.9)->value, 2);
  EXPECT_FALSE(insert("door", 4, 0.3)) << "too weak for a new one";
  EXPECT_EQ(insert("door", 1, 0.3)->value, 2);
  EXPECT_EQ(landmarks.size(), 3U);
}

TEST(BoxInsertion, LabelsVote) {
  std::vector<Landmark> landmarks = {test::sampleLandmark(4, "sofa", ShapeKind::kCuboid, 1, 0)};
  landmarks[0].observations = 3;
  landmarks[0].class_posterior = {{"sofa", 2.0 / 3}, {"bench", 1.0 / 3}};
  Landmark sighting = landmarks[0];
  EXPECT_EQ(insertSighting(sighting, 0.5, {}, landmarks)->value, 4);
  EXPECT_NEAR(landmarks[0].class_posterior.at("sofa"), 3.0 / 4, 1e-12);
  EXPECT_NEAR(landmarks[0].class_posterior.at("bench"), 1.0 / 4, 1e-12);
}

}  // namespace
}  // namespace roomgraph
