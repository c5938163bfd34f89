// SPDX-License-Identifier: BSD-3-Clause
// Tracking that is repeated with a part of what it found the first time: the same bits, keyframes, losses and
// all.
#include <gtest/gtest.h>

#include "feature_odometry.h"
#include "results_in_memory.h"
#include "roomgraph/core/errors.h"
#include "textured_room.h"
#include "view_bytes.h"

namespace roomgraph {
namespace {

using test::ResultsInMemory;

/// Round and back, so that a loop closes; with images that show nothing, a person, and a jump to another
/// place in between.
std::vector<Frame> recordedFrames() {
  const test::TexturedRoom room;
  std::vector<Frame> frames;
  for (int i = 0; i < 44; ++i) {
    const double s = 0.05 * (i < 22 ? i : 44 - i);
    Pose3 pose = Pose3::Identity();
    pose.linear() = expSO3({0, (i >= 30 && i < 34 ? 3.0 : 0.0) + 0.6 * std::sin(s), 0});
    pose.translation() << 0.9 * std::sin(s), 0, 0.6 * (1 - std::cos(s));
    frames.push_back(room.render(0.1 * i, pose));
    if (i == 12 || i == 13) frames.back().gray.setTo(90);
  }
  return frames;
}

void append(std::vector<double>& out, const Pose3& pose) {
  for (const double value : pose.matrix().reshaped()) out.push_back(value);
}

/// All numbers that come out of it.
std::vector<double> track(const std::vector<Frame>& frames, ResultStore* results) {
  FeatureOdometry odometry;
  odometry.prepare();
  if (results) odometry.setResultStore(*results);
  std::vector<double> out;
  for (const Frame& frame : frames) {
    TrackingPrior prior;
    if (frame.t > 0.5 && frame.t < 1) prior.dynamic_regions.push_back({40, 40, 120, 200});
    const TrackingResult result = odometry.track(frame, prior);
    append(out, result.odom_from_camera);
    for (const double value : result.step_covariance.reshaped()) out.push_back(value);
    for (const int number :
         {result.segment, result.inliers, result.matches, int(result.tracked), int(result.keyframe)})
      out.push_back(number);
    for (const auto& feature : result.features)
      out.insert(out.end(),
                 {feature.pixel.x(), feature.pixel.y(), static_cast<double>(feature.point), feature.depth_m});
  }
  const Trajectory trajectory = odometry.trajectory();
  for (const auto& stamped : trajectory.poses()) append(out, stamped.pose);
  for (const auto& closure : odometry.takeLoopClosures()) {
    out.insert(out.end(), {closure.t_a, closure.t_b});
    append(out, closure.a_from_b);
  }
  if (const auto verified = odometry.verifyLoop({0, 4.3, Pose3::Identity()})) append(out, verified->a_from_b);
  return out;
}

TEST(RepeatedTracking, WithAnyBeginningOfItsResultsGivesTheSameBits) {
  const auto frames = recordedFrames();
  const auto undisturbed = track(frames, nullptr);
  ResultsInMemory first;
  EXPECT_EQ(track(frames, &first), undisturbed) << "to keep results changes nothing";
  std::size_t views = 0, adjustments = 0, nothing = 0;
  for (const auto& result : first.all) {
    views += result.name == "view" && !result.bytes.empty();
    adjustments += result.name == "local adjustment";
    nothing += result.name == "view" && result.bytes.empty();
  }
  EXPECT_GT(views, 10u);
  EXPECT_GT(adjustments, 3u);
  EXPECT_GT(nothing, 5u) << "keyframes, and frames that were lost";
  for (std::size_t count = 0; count <= first.kept; count += 17) {
    ResultsInMemory again = first.beginning(count);
    EXPECT_EQ(track(frames, &again), undisturbed) << "with " << count << " of " << first.kept << " results";
    EXPECT_EQ(again.next, count);
    EXPECT_EQ(again.kept, first.kept - count);
  }
}

// Otherwise the test above would compare computations only: images without anything in them do for recalled
// frames.
TEST(RepeatedTracking, DoesNotLookAtImagesWhoseViewsAreKnown) {
  auto frames = recordedFrames();
  frames.resize(12);
  ResultsInMemory first;
  const auto undisturbed = track(frames, &first);
  for (const auto& result : first.all)
    for (Frame& frame : frames)
      if (result.name == "view" && result.t == frame.t && !result.bytes.empty()) frame.gray.setTo(0);
  ResultsInMemory again = first.beginning(first.kept);
  EXPECT_EQ(track(frames, &again), undisturbed);
  EXPECT_EQ(again.kept, 0u);
}

// By an older keyframe far from where the last view was: whether a segment begins there depends on what led there.
TEST(RepeatedTracking, AJumpIsOneAgain) {
  const test::TexturedRoom room;
  std::vector<Frame> frames;
  for (int i = 0; i < 33; ++i) {
    Pose3 pose = Pose3::Identity();
    pose.linear() = expSO3({0, i < 31 ? 0.1 * i : 0.05 * (i - 30), 0});
    frames.push_back(room.render(i < 31 ? 0.1 * i : 1.5 + 0.1 * i, pose));
  }
  ResultsInMemory first;
  const auto undisturbed = track(frames, &first);
  FeatureOdometry odometry;
  odometry.prepare();
  for (const Frame& frame : frames) odometry.track(frame, {});
  const Trajectory once = odometry.trajectory();
  ASSERT_EQ(once.segment(30), 0);
  ASSERT_EQ(once.segment(32), 1);
  ResultsInMemory again = first.beginning(first.kept);
  EXPECT_EQ(track(frames, &again), undisturbed);
  EXPECT_EQ(again.kept, 0u);
}

TEST(RepeatedTracking, AViewThroughBytesIsTheSame) {
  tracking::LocatedView view;
  view.features.places = {{{1.0f / 3, 7.25f}}, {{639.5f, 0}}};
  view.features.depth = {2.5f, 0};
  view.points = {0, 4000000000};
  view.in_view = {5};
  view.odom_from_camera.translation() << 1e-17, 2, -3;
  view.odom_from_camera.linear() = expSO3({0.1, 0.2, 0.3});
  view.covariance(2, 5) = 0.1 + 0.2;
  view.inliers = 2, view.matches = 3, view.reference = 4, view.reference_inliers = 5;
  const auto back = tracking::locatedView(bytesOf(view));
  ASSERT_EQ(back.features.size(), 2u);
  EXPECT_EQ(back.features.places[0].pt, view.features.places[0].pt);
  EXPECT_EQ(back.features.places[1].pt, view.features.places[1].pt);
  EXPECT_EQ(back.features.depth, view.features.depth);
  EXPECT_EQ(back.points, view.points);
  EXPECT_EQ(back.in_view, view.in_view);
  EXPECT_TRUE(back.odom_from_camera.matrix() == view.odom_from_camera.matrix());
  EXPECT_TRUE(back.covariance == view.covariance);
  EXPECT_EQ(back.inliers, 2);
  EXPECT_EQ(back.matches, 3);
  EXPECT_EQ(back.reference, 4);
  EXPECT_EQ(back.reference_inliers, 5);
}

TEST(RepeatedTracking, BytesThatAreNoViewAreRefused) {
  tracking::LocatedView view;
  view.features.places = {{{1, 2}}, {{3, 4}}};
  view.features.depth = {2.5f, 0};
  view.points = {0, 1};
  const std::string good = bytesOf(view);
  EXPECT_NO_THROW(tracking::locatedView(good));
  // MRPT takes a part of a number for the number when it stands at the end.
  for (std::size_t size = 0; size + sizeof(int) <= good.size(); ++size)
    EXPECT_ANY_THROW(tracking::locatedView(good.substr(0, size))) << size;
  view.points.push_back(2);
  EXPECT_THROW(tracking::locatedView(bytesOf(view)), std::invalid_argument) << "a point without a feature";
}

// A journal whose view shows points that the map of this run does not have.
TEST(RepeatedTracking, AViewOfAnotherMapIsAnInputError) {
  auto frames = recordedFrames();
  frames.resize(8);
  ResultsInMemory results;
  track(frames, &results);
  bool changed = false;
  for (auto& result : results.all) {
    if (result.name != "view" || result.bytes.empty()) continue;
    auto view = tracking::locatedView(result.bytes);
    view.in_view.push_back(1 << 20);
    result.bytes = tracking::bytesOf(view);
    changed = true;
  }
  ASSERT_TRUE(changed);
  auto again = results.beginning(results.all.size());
  EXPECT_THROW(track(frames, &again), InputError);
}

}  // namespace
}  // namespace roomgraph
