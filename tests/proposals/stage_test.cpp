// SPDX-License-Identifier: BSD-3-Clause
// GeometricProposalGenerator as a stage: order, determinism, missing depth, traces.
#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <limits>

#include "depth_ground_detector.h"
#include "geometric_proposal_generator.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/config.h"
#include "roomgraph/proposals/register_classes.h"
#include "scene.h"

namespace roomgraph {
namespace {

using test::database;
using test::Scene;

class StageTest : public ::testing::Test {
 protected:
  void SetUp() override {
    scene_.lookAhead(0.8, 0.2);
    scene_.addCylinder(2.2, 0.7, 0.31, 0.95, 1);
    scene_.addSofa(3.0, -0.6, 2.8, 1.8, 0.9, 0.8, 2);
    scene_.addCylinder(1.6, -0.7, 0.25, 1.7, 3);
    cv::Mat labels;
    frame_ = scene_.render(&labels);
    frame_.id = FrameId{4};
    frame_.t = 12.5;
    detections_ = {test::detectionOf(1, labels, "swivel_chair"), test::detectionOf(2, labels, "sofa"),
                   test::detectionOf(3, labels, "person")};
    generator_.setDatabase(database());
    generator_.prepare();
    expected_ = groundInCamera(scene_.world_from_camera);
  }
  FrameProposals proposalsOf(const Frame& frame, const std::vector<Detection>& detections,
                             const std::optional<Plane>& expected) {
    return generator_.generate(frame, detections, groundOf(frame, expected, ground_detector_));
  }

  Scene scene_;
  Frame frame_;
  std::vector<Detection> detections_;
  DepthGroundDetector ground_detector_;
  GeometricProposalGenerator generator_;
  Plane expected_;
};

TEST_F(StageTest, EveryDetectionHasProposalsInOrder) {
  const FrameProposals out = proposalsOf(frame_, detections_, expected_);
  EXPECT_EQ(out.frame, FrameId{4});
  EXPECT_EQ(out.t, 12.5);
  ASSERT_TRUE(out.ground);
  EXPECT_TRUE(out.ground->from_depth);
  std::vector<int> count(3, 0);
  for (const Proposal& p : out.proposals) {
    ++count.at(p.detection);
    EXPECT_EQ(p.class_name, detections_[p.detection].class_name);
    EXPECT_GT(p.score, 0);
    EXPECT_LE(p.score, 1);
    EXPECT_GE(p.box_iou, 0.3);
    // Sides that a nearer object hides are not compared: the sofa is behind both others.
    EXPECT_NEAR(p.box_iou, iou(p.projected.visible, detections_[p.detection].box), 1e-9);
    EXPECT_EQ(p.covariance.llt().info(), Eigen::Success);
    EXPECT_FALSE(p.reasons.empty());
    EXPECT_EQ(p.has_yaw, p.class_name == "sofa");
  }
  for (const int n : count) EXPECT_GE(n, 1);
  const Pose3 chair = scene_.world_from_camera * out.proposals.front().camera_from_object;
  EXPECT_NEAR(chair.translation().x(), 2.2, 0.08);
  EXPECT_NEAR(chair.translation().y(), 0.7, 0.08);
  EXPECT_NEAR(chair.translation().z(), 0, 0.02);
}

// A post hides the left two thirds of a chair. It is the larger part of what is seen in the box, but no chair fits it.
TEST_F(StageTest, TheObjectBehindAnOccluderIsFound) {
  Scene scene;
  scene.lookAhead(0.8, 0.2);
  scene.addCylinder(3, 0, 0.31, 0.95, 1);
  cv::Mat labels;
  scene.render(&labels);
  const Detection whole = test::detectionOf(1, labels, "swivel_chair");
  scene.addBox(1.6, 0.06, 0, 0.22, 0.1, 0, 1.2, 2);
  const FrameProposals out = proposalsOf(scene.render(), {whole}, expected_);
  ASSERT_FALSE(out.proposals.empty());
  const Pose3 chair = scene.world_from_camera * out.proposals.front().camera_from_object;
  EXPECT_LT((chair.translation().head<2>() - Eigen::Vector2d(3, 0)).norm(), 0.25);
}

// The post hides its left side as well: the place across the view is as unsure as behind the border of the image.
TEST_F(StageTest, AHiddenSideBehindAnOccluderMakesThePlaceUnsure) {
  Scene scene;
  scene.lookAhead(0.8, 0.2);
  scene.addCylinder(3, 0, 0.31, 0.95, 1);
  cv::Mat labels;
  const Frame in_the_open = scene.render(&labels);
  const Detection whole = test::detectionOf(1, labels, "swivel_chair");
  scene.addBox(1.6, 0.15, 0, 0.24, 0.1, 0, 1.2, 2);
  const FrameProposals open = proposalsOf(in_the_open, {whole}, expected_), behind = proposalsOf(scene.render(), {whole}, expected_);
  ASSERT_FALSE(open.proposals.empty() || behind.proposals.empty());
  const auto across = [](const FrameProposals& out) { return out.proposals.front().covariance(1, 1); };
  const Pose3 chair = scene.world_from_camera * behind.proposals.front().camera_from_object;
  EXPECT_LT((chair.translation().head<2>() - Eigen::Vector2d(3, 0)).norm(), 0.25);
  EXPECT_GT(across(behind), 2.5 * across(open));
}

TEST_F(StageTest, SameInputSameOutput) {
  const FrameProposals a = proposalsOf(frame_, detections_, expected_);
  const FrameProposals b = proposalsOf(frame_, detections_, expected_);
  ASSERT_EQ(a.proposals.size(), b.proposals.size());
  for (std::size_t i = 0; i < a.proposals.size(); ++i) {
    EXPECT_EQ(a.proposals[i].camera_from_object.matrix(), b.proposals[i].camera_from_object.matrix());
    EXPECT_EQ(a.proposals[i].score, b.proposals[i].score);
  }
}

TEST_F(StageTest, WithoutDepthTheExpectedGroundServes) {
  Config::fromText("[proposals]\nuse_depth = false\n", "test").read("proposals", generator_);
  ExpectedGroundDetector expected_only;
  const FrameGround predicted = groundOf(frame_, expected_, expected_only);
  ASSERT_TRUE(predicted.estimate);
  EXPECT_FALSE(predicted.estimate->from_depth);
  EXPECT_EQ(predicted.estimate->plane.normal, expected_.normal);
  const FrameProposals out = generator_.generate(frame_, detections_, predicted);
  ASSERT_TRUE(out.ground);
  EXPECT_FALSE(out.ground_reason.empty());
  EXPECT_FALSE(out.proposals.empty());
  for (const Proposal& p : out.proposals) EXPECT_THAT(p.reasons, ::testing::HasSubstr(" 0 depth points"));
  EXPECT_TRUE(generator_.generate(frame_, detections_, groundOf(frame_, std::nullopt, expected_only)).proposals.empty());
}

TEST_F(StageTest, AbsurdInputIsHarmless) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  std::vector<Detection> absurd(6, detections_[1]);
  absurd[0].box = {};
  absurd[1].box = {-1e9, -1e9, 1e9, 1e9};
  absurd[2].box = {300, 200, 10, 10};
  absurd[3].box = {100, 100, 100.4, 100.4};
  absurd[4].box = {nan, nan, nan, nan};
  absurd[5].box = {0, 0, inf, inf};
  for (const char* name : {"sofa", "swivel_chair", "door", "person", "unicorn"}) {
    for (auto& d : absurd) d.class_name = name;
    for (const Proposal& p : proposalsOf(frame_, absurd, expected_).proposals) {
      EXPECT_TRUE(p.camera_from_object.matrix().allFinite());
      EXPECT_TRUE(std::isfinite(p.score));
    }
  }
  Frame empty;
  const FrameProposals none = proposalsOf(empty, detections_, expected_);
  EXPECT_TRUE(none.proposals.empty());
  EXPECT_FALSE(none.ground_reason.empty());
  EXPECT_TRUE(proposalsOf(frame_, {}, expected_).proposals.empty());
}

TEST_F(StageTest, TracesOnlyWhenAskedFor) {
  const FrameProposals plain = proposalsOf(frame_, detections_, expected_);
  EXPECT_TRUE(plain.traces.empty());
  generator_.keepTraces(true);
  const FrameProposals traced = proposalsOf(frame_, detections_, expected_);
  ASSERT_EQ(traced.traces.size(), detections_.size());
  ASSERT_EQ(traced.proposals.size(), plain.proposals.size());
  std::size_t rejected = 0;
  for (std::size_t i = 0; i < detections_.size(); ++i) {
    EXPECT_GT(traced.traces[i].mask_pixels.size(), 50u);
    for (const auto& pixel : traced.traces[i].mask_pixels)
      EXPECT_TRUE(detections_[i].box.contains(pixel.x(), pixel.y()));
    for (const Proposal& p : traced.traces[i].rejected) {
      EXPECT_EQ(p.detection, static_cast<int>(i));
      EXPECT_FALSE(p.reasons.empty());
      ++rejected;
    }
  }
  EXPECT_GT(rejected, 0u);
  Detection unknown = detections_[0];
  unknown.class_name = "unicorn";
  EXPECT_EQ(proposalsOf(frame_, {unknown}, expected_).traces.size(), 1u);
}

TEST_F(StageTest, NaNDepthIsNoDepth) {
  frame_.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  const FrameProposals out = proposalsOf(frame_, detections_, expected_);
  ASSERT_TRUE(out.ground);
  EXPECT_FALSE(out.ground->from_depth);
  ASSERT_FALSE(out.proposals.empty());
  for (const Proposal& p : out.proposals) EXPECT_TRUE(p.camera_from_object.matrix().allFinite());
}

TEST_F(StageTest, MadeByClassName) {
  proposals::registerClasses();
  proposals::registerClasses();
  EXPECT_NE(createStage<ProposalGenerator>("GeometricProposalGenerator", "[proposals] class"), nullptr);
  EXPECT_NE(createStage<GroundDetector>("DepthGroundDetector", "[ground] class"), nullptr);
  EXPECT_NE(createStage<ShapeGenerator>("CuboidGenerator", "[sofa] generator"), nullptr);
}

}  // namespace
}  // namespace roomgraph
