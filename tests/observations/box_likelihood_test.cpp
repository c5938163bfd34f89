// SPDX-License-Identifier: BSD-3-Clause
// Likelihood of boxes: against integrals, enumeration of all associations, sampling and known truth.
#include "box_likelihood.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "roomgraph/geometry/projection.h"
#include "sample_map.h"

namespace roomgraph {
namespace {

const PinholeCamera kLikelyCamera{320, 240, 262.5, 262.5, 159.5, 119.5, {}};

/// Optical frame of a camera 0.8 m above the floor, looking along the yaw.
Pose3 cameraAt(double x, double y, double yaw) {
  Pose3 pose = poseFromYpr(x, y, 0.8, yaw, 0.2, 0);
  pose.linear() = pose.linear() * bodyFromOptical();
  return pose;
}

Landmark chairAt(double x, double y, std::int64_t id = 1) {
  return test::sampleLandmark(id, "swivel_chair", ShapeKind::kCylinder, x, y);
}

double integral(double from, double to, const std::function<double(double)>& f) {
  constexpr int kSteps = 200000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += f(from + (i + 0.5) * (to - from) / kSteps);
  return sum * (to - from) / kSteps;
}

// All outcomes of one side, on the border or anywhere off it, have the probability 1.
TEST(BoxLikelihood, SidesAreDistributions) {
  const Landmark landmark = chairAt(3, 0);
  const ExpectedBox expected{&landmark, {100, 60, 160, 170}, {9, 7, 5, 11}, 1};
  const Box2 rest{100, 60, 160, 170};
  const auto with = [&](int side, double value) {
    Box2 box = rest;
    *std::array{&box.u_min, &box.v_min, &box.u_max, &box.v_max}[static_cast<std::size_t>(side)] = value;
    return box;
  };
  for (int side = 0; side < 4; ++side) {
    const double size = side % 2 == 0 ? 320 : 240;
    const double low = side < 2 ? 3 : 0, high = side < 2 ? size : size - 3, cut = side < 2 ? 0 : size;
    for (const double hidden : {0.0, 0.2, 1.0}) {
      const auto density = [&](double value) {
        return boxDensityOf(with(side, value), expected, kLikelyCamera, hidden);
      };
      const double sigma = expected.sigma[side];
      const double place = std::array{100., 60., 160., 170.}[static_cast<std::size_t>(side)];
      const double of_side =
          (1 - hidden) / (std::sqrt(2 * std::numbers::pi) * sigma) + hidden / 2 / (size - 3);
      const double others = density(place) / of_side;
      EXPECT_NEAR((integral(low, high, density) + density(cut)) / others, 1, 1e-4) << side << " " << hidden;
    }
    const auto clutter = [&](double value) { return clutterDensity(with(side, value), kLikelyCamera); };
    EXPECT_NEAR((integral(low, high, clutter) + clutter(cut)) / (2 * clutter(cut)), 1, 1e-9) << side;
  }
}

TEST(BoxLikelihood, CutSidesAskWhetherTheObjectGoesOn) {
  const Landmark landmark = chairAt(3, 0);
  const Box2 cut{0, 60, 50, 170};
  const auto density = [&](double u_min) {
    return boxDensityOf(cut, {&landmark, {u_min, 60, 50, 170}, {10, 10, 10, 10}, 1}, kLikelyCamera, 0);
  };
  EXPECT_NEAR(density(3) / density(-200), 0.5, 1e-9) << "half of all would end before the border";
  EXPECT_NEAR(density(13) / density(-200), 0.158655253931, 1e-9) << "one standard deviation inside";
}

// p(Z | x) is the sum over all ways in which boxes come from landmarks and clutter.
TEST(BoxLikelihood, IsTheSumOverAllAssociations) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0, 1);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Landmark> landmarks;
    std::vector<ExpectedBox> expected;
    for (int j = 0; j < 3; ++j) {
      landmarks.push_back(chairAt(2 + j, 0, j));
      landmarks.back().class_posterior = {{"swivel_chair", u(random)}};
      landmarks.back().class_posterior["sofa"] = 1 - landmarks.back().class_posterior["swivel_chair"];
    }
    for (int j = 0; j < 3; ++j)
      expected.push_back({&landmarks[static_cast<std::size_t>(j)],
                          {80 + 20.0 * j, 60, 140 + 20.0 * j, 160},
                          {12, 12, 12, 12},
                          u(random)});
    std::vector<ClassBox> boxes;
    for (int k = 0; k < 4; ++k)
      boxes.push_back({{60 + 80 * u(random), 50 + 20 * u(random), 150 + 60 * u(random), 150 + 20 * u(random)},
                       k == 0 ? "sofa" : "swivel_chair"});
    MapLikelihoodOptions options;
    options.clutter_boxes = 0.1 + u(random);
    constexpr int kLabels = 5;
    double sum = 0;
    for (int code = 0; code < 256; ++code) {  // 4 boxes, each of clutter (0) or of one of 3 landmarks
      double product = 1;
      for (int k = 0, rest = code; k < 4; ++k, rest /= 4) {
        const ClassBox& box = boxes[static_cast<std::size_t>(k)];
        if (rest % 4 == 0) {
          product *= options.clutter_boxes / kLabels * clutterDensity(box.box, kLikelyCamera);
          continue;
        }
        const ExpectedBox& from = expected[static_cast<std::size_t>(rest % 4 - 1)];
        const double label = 0.95 * from.landmark->class_posterior.at(box.class_name) + 0.05 / kLabels;
        product *= from.count * label * boxDensityOf(box.box, from, kLikelyCamera, options.hidden_side);
      }
      sum += product;
    }
    for (const ExpectedBox& from : expected) sum *= std::exp(-from.count);
    EXPECT_NEAR(logLikelihoodOf(boxes, expected, kLikelyCamera, kLabels, options), std::log(sum), 1e-9);
  }
}

// The spread of projections of a landmark drawn from its covariance.
TEST(BoxLikelihood, SigmasAreThoseOfSamples) {
  Landmark landmark = chairAt(3, 0.4);
  landmark.shape = {ShapeKind::kCylinder, 0.3, 0.3, 0.5};
  Eigen::Matrix3d root;
  root << 0.05, 0, 0, 0.02, 0.06, 0, 0.005, -0.01, 0.02;
  landmark.covariance.topLeftCorner<3, 3>() = root * root.transpose();
  MapLikelihoodOptions options;
  options.box_sigma = 0;
  options.side_sigma_px = 0.1;
  const Pose3 camera = cameraAt(0, 0, 0.05);
  const auto expected = expectedBoxes({landmark}, nullptr, camera, kLikelyCamera, options);
  ASSERT_EQ(expected.size(), 1U);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  Eigen::Array4d sum = Eigen::Array4d::Zero(), squares = Eigen::Array4d::Zero();
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    Landmark drawn = landmark;
    drawn.position += root * Eigen::Vector3d(normal(random), normal(random), normal(random));
    const auto box =
        projectShape(drawn.shape, camera.inverse() * drawn.worldFromObject(), kLikelyCamera)->full;
    const Eigen::Array4d sides(box.u_min, box.v_min, box.u_max, box.v_max);
    sum += sides;
    squares += sides * sides;
  }
  const Eigen::Array4d spread = (squares / kSamples - (sum / kSamples).square()).sqrt();
  for (int side = 0; side < 4; ++side) EXPECT_NEAR(expected[0].sigma[side] / spread[side], 1, 0.12) << side;
}

TEST(BoxLikelihood, ExpectsWhatIsInView) {
  const MapLikelihoodOptions options;
  const auto count = [&](double x, double y, const mrpt::maps::COccupancyGridMap2D* grid = nullptr) {
    Landmark landmark = chairAt(x, y);
    landmark.existence = 0.5;
    const auto expected = expectedBoxes({landmark}, grid, cameraAt(0, 0, 0), kLikelyCamera, options);
    return expected.empty() ? 0 : expected[0].count;
  };
  EXPECT_NEAR(count(3, 0), 0.8 * 0.5, 1e-9) << "in full view";
  EXPECT_EQ(count(-3, 0), 0) << "behind";
  EXPECT_EQ(count(6.1, 0), 0) << "too far";
  EXPECT_NEAR(count(5.4, 0), 0.5 * 0.8 * 0.5, 1e-9) << "half way out of sight";
  EXPECT_LT(count(3, 1.9), 0.3 * 0.8 * 0.5 + count(3, 0) / 2) << "partly outside";
  EXPECT_GT(count(3, 1.9), 0);
  mrpt::maps::COccupancyGridMap2D wall(-1, 5, -3, 3, 0.05F);
  wall.fill(0.9F);
  for (float y = -2; y < 2; y += 0.04F) wall.setPos(1.5F, y, 0.05F);
  EXPECT_NEAR(count(3, 0, &wall), 0.1 * count(3, 0), 1e-9) << "behind a wall";
  EXPECT_NEAR(count(1.1, 0, &wall), count(1.1, 0), 1e-9) << "before it";
  EXPECT_TRUE(clearView(wall, {0, 2.5}, {3, 2.5}, 0)) << "past its end";
  EXPECT_FALSE(clearView(wall, {0, 0}, {3, 0}, 0.5));
  EXPECT_TRUE(clearView(wall, {0, 0}, {2, 0}, 0.6)) << "the object's own cells";
}

// Boxes seen from a place are likelier there than anywhere else around it, whatever else they may be.
TEST(BoxLikelihood, IsGreatestAtTheTruth) {
  std::vector<Landmark> landmarks = {chairAt(3, 0.7, 1), chairAt(2.6, -0.6, 2), chairAt(4, 0.1, 3)};
  MapLikelihoodOptions options;
  const Pose3 truth = cameraAt(0.3, 0.1, -0.05);
  std::vector<ClassBox> boxes = {{{20, 20, 60, 90}, "swivel_chair"}};  // a false alarm
  for (const auto& seen : expectedBoxes(landmarks, nullptr, truth, kLikelyCamera, options))
    boxes.push_back({clipped(seen.bounds, 320, 240), "swivel_chair"});
  ASSERT_EQ(boxes.size(), 4U);
  const auto at = [&](double dx, double dy, double turn) {
    const auto expected =
        expectedBoxes(landmarks, nullptr, cameraAt(0.3 + dx, 0.1 + dy, -0.05 + turn), kLikelyCamera, options);
    return logLikelihoodOf(boxes, expected, kLikelyCamera, 3, options);
  };
  double best = -1e9;
  Eigen::Vector3d where(9, 9, 9);
  for (int i = -10; i <= 10; ++i)
    for (int j = -10; j <= 10; ++j)
      for (int k = -10; k <= 10; ++k)
        if (const double value = at(i * 0.1, j * 0.1, k * 0.1); value > best) {
          best = value;
          where = {i * 0.1, j * 0.1, k * 0.1};
        }
  EXPECT_LT(where.head<2>().norm(), 0.15);
  EXPECT_LT(std::abs(where.z()), 0.05);
  EXPECT_GT(at(0, 0, 0), at(1, 0, 0) + 3);
  EXPECT_GT(at(0, 0, 0), at(0, 0, 3) + 5) << "looking away, all boxes are clutter";
}

TEST(BoxLikelihood, ClutterIsTheFloor) {
  const MapLikelihoodOptions options;
  const std::vector<ClassBox> boxes = {{{50, 40, 90, 100}, "sofa"}, {{0, 40, 90, 240}, "door"}};
  const double alone = logLikelihoodOf(boxes, {}, kLikelyCamera, 4, options);
  EXPECT_NEAR(alone,
              std::log(0.5 / 4 * std::pow(0.5 / 317, 2) * std::pow(0.5 / 237, 2)) +
                  std::log(0.5 / 4 * 0.5 * 0.5 * (0.5 / 317) * (0.5 / 237)),
              1e-9);
  const Landmark landmark = chairAt(3, 0);
  const ExpectedBox elsewhere{&landmark, {200, 60, 260, 170}, {5, 5, 5, 5}, 0.4};
  EXPECT_GE(logLikelihoodOf(boxes, {elsewhere}, kLikelyCamera, 4, options), alone - 0.4)
      << "a landmark costs its miss at most";
}

}  // namespace
}  // namespace roomgraph
