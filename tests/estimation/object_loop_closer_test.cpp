// SPDX-License-Identifier: BSD-3-Clause
// ObjectLoopCloser: chairs mapped twice, with drift in between, propose the closure that undoes the drift.
#include "roomgraph/estimation/object_loop_closer.h"

#include <gtest/gtest.h>

#include "roomgraph/association/register_classes.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/config.h"
#include "still_camera.h"

namespace roomgraph::test {
namespace {

// The robot stands at the origin, and maps three chairs at t = 0 .. 3 s and again, displaced, at t = 100 .. 103 s.
class TwoVisits : public ::testing::Test {
 protected:
  TwoVisits() : none_(MotionNoise{}, true), motion_{none_, none_, none_}, poses_(motion_) {
    association::registerClasses();
    poses_.add(0, Pose3::Identity());
    poses_.add(103, Pose3::Identity());
  }

  void visit(ObjectMapper& mapper, double since, double shift) {
    for (int i = 0; i < 7; ++i) {
      Frame frame;
      frame.id = FrameId{next_frame_++};
      frame.t = since + 0.5 * i;
      frame.robot_from_camera = poseFromYpr(0, 0, 1, 0, 0, 0);
      frame.robot_from_camera.linear() = bodyFromOptical();
      std::vector<ObjectMeasurement> chairs;
      for (const auto& [x, y] : {std::pair{3.0, 0.0}, {5.0, 1.5}, {4.0, -2.5}}) {
        ObjectMeasurement chair;
        chair.frame = frame.id;
        chair.t = frame.t;
        chair.proposal.class_name = chair.proposal.model = chair.detection.class_name = "chair";
        chair.proposal.shape = {ShapeKind::kCylinder, 0.6, 0.6, 0.9};
        chair.proposal.camera_from_object =
            frame.robot_from_camera.inverse() * poseFromYpr(x + shift, y, 0, 0, 0, 0);
        chair.proposal.covariance = 1e-4 * Eigen::Matrix4d::Identity();
        chair.proposal.score = chair.detection.score = 0.9;
        chairs.push_back(chair);
      }
      mapper.associate(chairs, frame, {}, noDrift());
    }
  }

  // The closure found, with a verifier that notes what it is asked and agrees to everything.
  std::optional<RelativePose> searchAfter(double shift) {
    std::shared_ptr<Associator> associator = createStage<Associator>("NearestNeighborAssociator", "test");
    Config::fromText("[association]\nmax_distance_ratio = 0.1\n", "test").read("association", *associator);
    ObjectMapper mapper(associator, {}, 0.01, poses_);
    visit(mapper, 0, 0);
    visit(mapper, 100, shift);
    EXPECT_EQ(mapper.landmarks().landmarks().size(), 6u) << "every chair is mapped twice";
    ObjectLoopOptions options;
    options.every_nodes = 2;
    ObjectLoopCloser closer(options);
    const auto verify = [this](const RelativePose& proposed) -> std::optional<RelativePose> {
      asked_.push_back(proposed);
      return agrees_ ? std::optional(proposed) : std::nullopt;
    };
    EXPECT_FALSE(closer.search(mapper, poses_, verify)) << "it searches with every second key pose";
    const auto closure = closer.search(mapper, poses_, verify);
    // Verification is expensive: the same pairs are not tried again at once.
    const std::size_t asked = asked_.size();
    if (!agrees_) {
      closer.search(mapper, poses_, verify);
      closer.search(mapper, poses_, verify);
      EXPECT_EQ(asked_.size(), asked);
    }
    return closure;
  }

  MotionSource none_;
  Motion motion_;
  KeyPoses poses_;
  std::int64_t next_frame_ = 0;
  std::vector<RelativePose> asked_;
  bool agrees_ = true;
};

TEST_F(TwoVisits, TheDisplacementOfTheChairsIsUndone) {
  const auto closure = searchAfter(1);
  ASSERT_TRUE(closure);
  EXPECT_EQ(closure->source, "objects");
  EXPECT_LT(closure->t_a, 4) << "from the first visit";
  EXPECT_GT(closure->t_b, 99) << "to the second";
  // The robot did not move: it is 1 m behind where the second visit has it.
  EXPECT_LT((closure->a_from_b.translation() - Eigen::Vector3d(-1, 0, 0)).norm(), 0.02);
  EXPECT_TRUE(closure->planar);
}

TEST_F(TwoVisits, ASmallDisplacementIsLeftToTheAssociation) {
  EXPECT_FALSE(searchAfter(0.2));
  EXPECT_TRUE(asked_.empty());
}

TEST_F(TwoVisits, WhatNobodyVerifiesIsNoClosure) {
  agrees_ = false;
  EXPECT_FALSE(searchAfter(1));
  EXPECT_FALSE(asked_.empty());
}

}  // namespace
}  // namespace roomgraph::test
