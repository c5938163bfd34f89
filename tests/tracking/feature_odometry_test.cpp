// SPDX-License-Identifier: BSD-3-Clause
// FeatureOdometry on a rendered room: accuracy, relocalisation, segments, dynamic regions.
#include "feature_odometry.h"

#include <gmock/gmock.h>

#include <set>
#include <thread>

#include "roomgraph/core/class_registry.h"
#include "roomgraph/tracking/register_classes.h"
#include "textured_room.h"
#include "tracker.h"

namespace roomgraph {
namespace {

using ::testing::HasSubstr;

/// Smooth curve through the room, looking around.
Pose3 poseAt(int i) {
  const double s = 0.04 * i;
  Pose3 pose = Pose3::Identity();
  pose.linear() = expSO3({0.05 * std::sin(2 * s), 0.4 * std::sin(s), 0.03 * std::sin(s)});
  pose.translation() << 0.8 * std::sin(s), 0.1 * std::sin(1.5 * s), 0.6 * (1 - std::cos(s));
  return pose;
}

const test::TexturedRoom& room() {
  static const test::TexturedRoom kRoom;
  return kRoom;
}

double distance(const Pose3& a, const Pose3& b) {
  return (a.inverse() * b).translation().norm();
}

TEST(FeatureOdometry, IsMadeByName) {
  tracking::registerClasses();
  EXPECT_TRUE(createStage<RgbdOdometry>("FeatureOdometry", "test"));
}

TEST(FeatureOdometry, FollowsAKnownMotion) {
  FeatureOdometry odometry;
  std::vector<Pose3> truth;
  std::set<std::int64_t> seen_before;
  for (int i = 0; i < 25; ++i) {
    truth.push_back(poseAt(i));
    const auto result = odometry.track(room().render(0.1 * i, truth.back()), {});
    ASSERT_TRUE(result.tracked) << i << ": " << result.reason;
    EXPECT_EQ(result.segment, 0);
    EXPECT_LT(distance(truth.front().inverse() * truth.back(), result.odom_from_camera), 0.02) << i;
    EXPECT_GT(result.step_covariance.llt().matrixL().determinant(), 0);
    int known = 0;
    for (const auto& feature : result.features) known += seen_before.contains(feature.point);
    if (i > 1) {
      EXPECT_GT(known, 50) << "point ids do not persist";
    }
    for (const auto& feature : result.features) seen_before.insert(feature.point);
  }
  const auto trajectory = odometry.trajectory();
  ASSERT_EQ(trajectory.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Pose3 error = (truth.front().inverse() * truth[i]).inverse() * trajectory.poses()[i].pose;
    EXPECT_LT(error.translation().norm(), 0.015) << i;
    EXPECT_LT(rotationAngle(error), 0.008) << i;
  }
}

// Some frames are foreseen, some with people in them; also one that never comes.
TEST(FeatureOdometry, FramesThatWereForeseenGiveTheSameBits) {
  FeatureOdometry plain, foreseeing;
  plain.prepare();
  foreseeing.prepare();
  std::vector<Frame> frames;
  for (int i = 0; i < 12; ++i) frames.push_back(room().render(0.1 * i, poseAt(i)));
  std::thread beside([&] {
    for (int i = 0; i < 12; ++i)
      if (i % 4 != 1) foreseeing.foresee(frames[static_cast<std::size_t>(i)]);
    foreseeing.foresee(room().render(5, poseAt(12)));
  });
  for (int i = 0; i < 12; ++i) {
    if (i == 6) beside.join();  // before it, whichever is faster
    const Frame& frame = frames[static_cast<std::size_t>(i)];
    TrackingPrior prior;
    if (i > 2 && i % 3 == 0) prior.dynamic_regions = {{40, 30, 200, 220}};
    const auto a = plain.track(frame, prior), b = foreseeing.track(frame, prior);
    ASSERT_TRUE(a.tracked && b.tracked) << i;
    EXPECT_EQ(a.odom_from_camera.matrix(), b.odom_from_camera.matrix()) << i;
    EXPECT_EQ(a.step_covariance, b.step_covariance) << i;
    ASSERT_EQ(a.features.size(), b.features.size()) << i;
  }
}

TEST(FeatureOdometry, StandsStillWhenTheCameraDoes) {
  FeatureOdometry odometry;
  const Frame frame = room().render(0, poseAt(3));
  for (int i = 0; i < 5; ++i) {
    Frame again = frame;
    again.t = i;
    const auto result = odometry.track(again, {});
    ASSERT_TRUE(result.tracked);
    EXPECT_LT(distance(Pose3::Identity(), result.odom_from_camera), 1e-3);
  }
}

TEST(FeatureOdometry, UsesThePriorForLargeJumps) {
  FeatureOdometry odometry;
  odometry.track(room().render(0, Pose3::Identity()), {});
  Pose3 jump = Pose3::Identity();
  jump.linear() = expSO3({0, 0.35, 0});
  const auto result =
      odometry.track(room().render(1, jump), {.previous_from_current = jump, .dynamic_regions = {}});
  ASSERT_TRUE(result.tracked);
  EXPECT_LT(rotationAngle(jump.inverse() * result.odom_from_camera), 0.01);
}

TEST(FeatureOdometry, SaysWhyAFrameCannotBeUsed) {
  FeatureOdometry odometry;
  Frame frame = room().render(0, Pose3::Identity());
  Frame no_depth = frame;
  no_depth.depth = cv::Mat();
  EXPECT_EQ(odometry.track(no_depth, {}).reason, "no depth");
  Frame zero_depth = frame;
  zero_depth.depth = cv::Mat(frame.depth.size(), CV_32FC1, cv::Scalar(0));
  EXPECT_EQ(odometry.track(zero_depth, {}).reason, "no depth");
  Frame no_image = frame;
  no_image.gray = no_image.color = cv::Mat();
  EXPECT_EQ(odometry.track(no_image, {}).reason, "no image");
  frame.t = 1;
  EXPECT_TRUE(odometry.track(frame, {}).tracked);
  EXPECT_THAT(odometry.track(frame, {}).reason, HasSubstr("time stamp"));
  EXPECT_EQ(odometry.trajectory().size(), 1u);
}

Frame blank(double t) {
  Frame frame = room().render(t, Pose3::Identity());
  frame.gray.setTo(128);
  return frame;
}

TrackingParameters featuresAlone() {
  TrackingParameters parameters;
  parameters.dense_alignment = false;
  return parameters;
}

TEST(FeatureOdometry, RelocalisesAfterBlankImages) {
  tracking::Tracker odometry(featuresAlone());
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(odometry.track(room().render(i, poseAt(i)), {}).tracked);
  for (int i = 3; i < 20; ++i) {
    const auto result = odometry.track(blank(i), {});
    EXPECT_FALSE(result.tracked);
    EXPECT_EQ(result.reason, "too few features");
  }
  const auto back = odometry.track(room().render(20, poseAt(1)), {});
  ASSERT_TRUE(back.tracked);
  EXPECT_EQ(back.segment, 0);
  EXPECT_LT(distance(poseAt(0).inverse() * poseAt(1), back.odom_from_camera), 0.01);
}

// Along the corner of the room and round, 4 cm and 2 degrees a frame.
Pose3 inCorner(int i) {
  return poseFromYpr(0.6 + 0.04 * i, 0.1, 0.2, 0, 0.5 + 0.035 * i, -0.5);
}

Frame withoutFeatures(int i) {
  Frame frame = room().render(i, inCorner(i));
  frame.gray.setTo(128);
  return frame;
}

TEST(FeatureOdometry, FollowsDepthWhereThereAreNoFeatures) {
  TrackingParameters parameters;
  parameters.dense_alignment = true;
  tracking::Tracker odometry(parameters);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(odometry.track(room().render(i, inCorner(i)), {}).tracked);
  for (int i = 3; i < 20; ++i) {
    const auto result = odometry.track(withoutFeatures(i), {});
    ASSERT_TRUE(result.tracked) << i;
    EXPECT_THAT(result.reason, HasSubstr("by depth and brightness"));
    EXPECT_EQ(result.segment, 0);
    const Pose3 error = result.odom_from_camera.inverse() * inCorner(0).inverse() * inCorner(i);
    EXPECT_LT(error.translation().norm(), 0.02) << i;
    EXPECT_LT(error.translation().norm(), 3 * std::sqrt(result.step_covariance.topLeftCorner(3, 3).trace()));
  }
  EXPECT_EQ(odometry.trajectory().size(), 20u);
  EXPECT_TRUE(odometry.takeLoopClosures().empty());
  // Features again, of what was never seen: a new segment, and how it is placed in the old one.
  int first = 20;
  while (odometry.track(room().render(first, inCorner(first)), {}).segment == 0) ASSERT_LT(++first, 30);
  const auto links = odometry.takeLoopClosures();
  ASSERT_EQ(links.size(), 1u);
  EXPECT_TRUE(links[0].link);
  EXPECT_EQ(links[0].t_b, first);
  EXPECT_LT(distance(inCorner(static_cast<int>(links[0].t_a)).inverse() * inCorner(first), links[0].a_from_b), 0.04);
}

TEST(FeatureOdometry, WhereScansSawTheMovementFeaturesAloneCount) {
  tracking::Tracker odometry({});
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(odometry.track(room().render(i, inCorner(i)), {}).tracked);
  TrackingPrior prior{.previous_from_current = inCorner(2).inverse() * inCorner(3)};
  EXPECT_TRUE(odometry.track(withoutFeatures(3), prior).tracked) << "wheels";
  prior = {.previous_from_current = inCorner(3).inverse() * inCorner(4), .by_scans = true};
  const auto result = odometry.track(withoutFeatures(4), prior);
  EXPECT_FALSE(result.tracked);
  EXPECT_EQ(result.reason, "too few features");
}

// For a moment a velocity goes on; its variance grows until something is seen again.
TEST(FeatureOdometry, PredictsWhileNothingIsSeen) {
  tracking::Tracker odometry({});
  const auto at = [](int i) { return 0.1 * i; };
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(odometry.track(room().render(at(i), inCorner(i)), {}).tracked);
  double before = 0;
  for (int i = 5; i < 12; ++i) {
    Frame frame = withoutFeatures(i);
    frame.t = at(i);
    frame.depth.setTo(0);
    const auto result = odometry.track(frame, {});
    EXPECT_FALSE(result.tracked);
    EXPECT_TRUE(result.predicted) << i;
    const Pose3 error = result.odom_from_camera.inverse() * inCorner(0).inverse() * inCorner(i);
    EXPECT_LT(error.translation().norm(), 0.05) << "it moved on as before";
    const double sigma = std::sqrt(result.step_covariance.topLeftCorner(3, 3).trace());
    EXPECT_GT(sigma, before);
    before = sigma;
  }
  Frame seen = withoutFeatures(12);
  seen.t = at(12);
  const auto back = odometry.track(seen, {});
  EXPECT_FALSE(back.tracked) << "there is nothing to compare it with";
  EXPECT_TRUE(back.predicted);
  seen = withoutFeatures(13);
  seen.t = at(13);
  EXPECT_TRUE(odometry.track(seen, {}).tracked);
  for (int i = 14; i < 40; ++i) {
    Frame frame = withoutFeatures(13);
    frame.t = at(i);
    frame.depth.setTo(0);
    const auto result = odometry.track(frame, {});
    EXPECT_EQ(result.predicted, i < 13 + 15) << "1.5 s";
  }
}

// A step over a second without images is that of a second.
TEST(FeatureOdometry, AVelocityAfterAGapIsThatOfItsTime) {
  const auto poseAt = [](double t) { return poseFromYpr(-1.2 + 0.3 * t, 0, 0, 0, 0, 0); };
  for (const double gap_s : {0.1, 1.0, 1.9}) {
    tracking::Tracker odometry({});
    double t = 0;
    for (int i = 0; i <= 20; ++i, t = 0.1 * i) ASSERT_TRUE(odometry.track(room().render(t, poseAt(t)), {}).tracked);
    t = 2 + gap_s;
    ASSERT_TRUE(odometry.track(room().render(t, poseAt(t)), {}).tracked) << gap_s;
    TrackingResult covered;
    for (int i = 1; i <= 14; ++i) {
      Frame frame = room().render(t + 0.1 * i, poseAt(t));
      frame.gray.setTo(0);
      frame.color.setTo(0);
      frame.depth.setTo(0);
      covered = odometry.track(frame, {});
      EXPECT_TRUE(covered.predicted);
    }
    const double error_m = std::abs(covered.odom_from_camera.translation().x() - 0.3 * (t + 1.4));
    EXPECT_LT(error_m, std::sqrt(covered.step_covariance(0, 0))) << gap_s;
  }
}

// What was seen long ago is no reference, nor its velocity a guess.
TEST(FeatureOdometry, AChainEndsWithItsImages) {
  tracking::Tracker odometry({});
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(odometry.track(room().render(0.1 * i, inCorner(i)), {}).tracked);
  const Pose3 last = odometry.trajectory().poses().back().pose;
  Pose3 before = last;
  for (int i = 3; i < 40; ++i) {
    Frame nothing = withoutFeatures(i);
    nothing.t = 0.1 * i;
    nothing.depth = cv::Mat();
    const auto result = odometry.track(nothing, {});
    EXPECT_EQ(result.reason, "no depth");
    if (i > 20) {
      EXPECT_LT(distance(before, result.odom_from_camera), 1e-9) << "it no longer goes on";
    }
    before = result.odom_from_camera;
  }
  Frame late = withoutFeatures(3);
  late.t = 4;
  const auto result = odometry.track(late, {});
  EXPECT_FALSE(result.tracked);
  EXPECT_FALSE(result.predicted);
}

TEST(FeatureOdometry, OpensASegmentInAnUnknownPlace) {
  tracking::Tracker odometry(featuresAlone());
  for (int i = 0; i < 3; ++i) odometry.track(room().render(i, poseAt(i)), {});
  const test::TexturedRoom elsewhere(77);
  int first_tracked = 0;
  for (int i = 3; i < 15; ++i) {
    const auto result = odometry.track(elsewhere.render(i, poseAt(i)), {});
    if (!result.tracked) continue;
    if (first_tracked == 0) first_tracked = i;
    EXPECT_EQ(result.segment, 1);
  }
  EXPECT_GT(first_tracked, 3);
  const auto trajectory = odometry.trajectory();
  EXPECT_EQ(trajectory.segment(trajectory.size() - 1), 1);
  EXPECT_FALSE(trajectory.between(1, 14).has_value());
  EXPECT_LT(distance(poseAt(10).inverse() * poseAt(14), *trajectory.between(10, 14)), 0.02);

  // Back in the first place, in its frame: another segment, as no step leads there. A measurement ties it to an older frame.
  odometry.takeLoopClosures();
  const auto back = odometry.track(room().render(20, poseAt(1)), {});
  ASSERT_TRUE(back.tracked);
  EXPECT_EQ(back.segment, 2);
  EXPECT_LT(distance(poseAt(0).inverse() * poseAt(1), back.odom_from_camera), 0.01);
  const auto links = odometry.takeLoopClosures();
  ASSERT_EQ(links.size(), 1u);
  EXPECT_EQ(links[0].t_b, 20);
  EXPECT_LT(distance(poseAt(static_cast<int>(links[0].t_a)).inverse() * poseAt(1), links[0].a_from_b), 0.01);

  // Another unknown place: its segment is none that there was.
  const test::TexturedRoom third(78);
  int segment = 2;
  for (int i = 21; i < 35 && segment == 2; ++i)
    if (const auto result = odometry.track(third.render(i, poseAt(i)), {}); result.tracked) segment = result.segment;
  EXPECT_EQ(segment, 3);
}

TEST(FeatureOdometry, RefusesATinyImage) {
  FeatureOdometry odometry;
  Frame frame = room().render(0, Pose3::Identity());
  cv::resize(frame.gray, frame.gray, {20, 15});
  cv::resize(frame.depth, frame.depth, {20, 15});
  frame.camera = frame.camera.scaled(1.0 / 16);
  EXPECT_EQ(odometry.track(frame, {}).reason, "too few features");
}

/// Pastes a moving textured patch, nearer than the wall, into a frame.
void addMover(Frame& frame, int column) {
  const Frame texture = test::TexturedRoom(9).render(0, Pose3::Identity());
  const cv::Rect place(column, 20, 170, 200);
  texture.gray(cv::Rect(60, 20, 170, 200)).copyTo(frame.gray(place));
  frame.depth(place).setTo(1.F);
}

TEST(FeatureOdometry, IgnoresDynamicRegions) {
  FeatureOdometry odometry;
  for (int i = 0; i < 8; ++i) {
    Frame frame = room().render(i, Pose3::Identity());
    const int column = 10 + 15 * i;
    addMover(frame, column);
    TrackingPrior prior;
    prior.dynamic_regions = {{column - 4.0, 16, column + 174.0, 224}};
    const auto result = odometry.track(frame, prior);
    ASSERT_TRUE(result.tracked) << i << result.reason;
    EXPECT_LT(distance(Pose3::Identity(), result.odom_from_camera), 0.01) << i;
    for (const auto& feature : result.features)
      EXPECT_FALSE(
          Box2({column + 0.0, 20, column + 170.0, 220}).contains(feature.pixel.x(), feature.pixel.y()));
  }
}

TEST(FeatureOdometry, TwoRunsAreIdentical) {
  FeatureOdometry first, second;
  for (int i = 0; i < 12; ++i) {
    const Frame frame = room().render(0.1 * i, poseAt(2 * i));
    EXPECT_EQ(first.track(frame, {}).odom_from_camera.matrix(),
              second.track(frame, {}).odom_from_camera.matrix());
  }
  const auto a = first.trajectory(), b = second.trajectory();
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_EQ(a.poses()[i].pose.matrix(), b.poses()[i].pose.matrix());
}

}  // namespace
}  // namespace roomgraph
