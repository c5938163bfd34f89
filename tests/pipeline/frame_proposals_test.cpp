// SPDX-License-Identifier: BSD-3-Clause
// Proposals of a frame: beside its tracking, after it, and what they throw.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <opencv2/core/utility.hpp>
#include <thread>

#include "drive.h"
#include "fake_stages.h"
#include "roomgraph/core/errors.h"

namespace roomgraph::test {
namespace {

constexpr auto kPatience = std::chrono::seconds(20);

class FrameProposalsTest : public ::testing::Test {
 protected:
  FrameProposalsTest() {
    registerAllClasses();
    fakes::registerClasses();
    fakes::world() = {};
    fakes::world().world_from_camera = [](double t) { return toPose3(Drive::truth(t)) * Drive::robotFromCamera(); };
    fakes::world().while_tracking = [this] { tracking_ = std::this_thread::get_id(); };
    fakes::world().while_proposing = [this] {
      proposing_ = std::this_thread::get_id();
      tracked_before_ = tracking_.has_value();
    };
  }
  ~FrameProposalsTest() override { cv::setNumThreads(threads_before_); }

  static auto setup() {
    return setupWith("[detection]\nclass = FakeDetector\n[proposals]\nclass = FakeProposals\n[tracking]\nclass = FakeOdometry\n");
  }

  int threads_before_ = cv::getNumThreads();
  std::optional<std::thread::id> tracking_, proposing_;
  bool tracked_before_ = false;
};

TEST_F(FrameProposalsTest, OfARobotAreMadeWhileItIsTracked) {
  cv::setNumThreads(2);
  std::promise<void> tracking, proposing;
  bool met = true;
  const auto meet = [&met](std::promise<void>& mine, std::promise<void>& other) {
    return [&, theirs = other.get_future().share()] {
      mine.set_value();
      if (theirs.wait_for(kPatience) != std::future_status::ready) met = false;
    };
  };
  fakes::world().while_tracking = meet(tracking, proposing);
  fakes::world().while_proposing = meet(proposing, tracking);
  SemanticSlam slam(setup());
  slam.process(Drive::frame(0));
  EXPECT_TRUE(met) << "one waited for the other to end";
  EXPECT_EQ(slam.times().totals().at("proposals").calls, 1);
}

TEST_F(FrameProposalsTest, WithOneThreadOneFollowsTheOther) {
  cv::setNumThreads(1);
  SemanticSlam slam(setup());
  slam.process(Drive::frame(0));
  EXPECT_EQ(proposing_, std::this_thread::get_id());
  EXPECT_EQ(tracking_, std::this_thread::get_id());
  EXPECT_TRUE(tracked_before_);
}

// Where its floor is depends on its pose.
TEST_F(FrameProposalsTest, OfAHandheldCameraFollowItsTracking) {
  cv::setNumThreads(2);
  SemanticSlam slam(setup());
  Frame frame = Drive::frame(0);
  frame.robot_from_camera = Pose3::Identity();
  slam.process(frame);
  EXPECT_EQ(proposing_, std::this_thread::get_id());
  EXPECT_TRUE(tracked_before_);
}

TEST_F(FrameProposalsTest, WhatTheyThrowComesFromTheRecord) {
  for (const int threads : {1, 2}) {
    cv::setNumThreads(threads);
    fakes::world().while_proposing = [] { throw RunError("no proposals today"); };
    SemanticSlam slam(setup());
    EXPECT_THROW(slam.process(Drive::frame(0)), RunError) << threads;
  }
}

// The tracker's error counts; the proposals are waited for, as they use the frame.
TEST_F(FrameProposalsTest, AreWaitedForWhenTheTrackingFails) {
  cv::setNumThreads(2);
  std::promise<void> failed;
  std::atomic<bool> ended = false;
  fakes::world().while_tracking = [&] {
    failed.set_value();
    throw RunError("no tracking today");
  };
  fakes::world().while_proposing = [&, begun = failed.get_future().share()] {
    begun.wait_for(kPatience);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ended = true;
  };
  SemanticSlam slam(setup());
  EXPECT_THROW(slam.process(Drive::frame(0)), RunError);
  EXPECT_TRUE(ended);
}

}  // namespace
}  // namespace roomgraph::test
