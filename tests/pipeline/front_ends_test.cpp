// SPDX-License-Identifier: BSD-3-Clause
// Between camera and robot: predictions, covariances of steps, and verified closures in the right frames.
#include "roomgraph/pipeline/front_ends.h"

#include <gtest/gtest.h>

#include "drive.h"
#include "fake_stages.h"
#include "roomgraph/pipeline/semantic_slam.h"

namespace roomgraph::test {
namespace {

class FrontEndsTest : public ::testing::Test {
 protected:
  FrontEndsTest() {
    registerAllClasses();
    fakes::registerClasses();
    fakes::world() = {};
    fakes::world().world_from_camera = [](double t) {
      return toPose3(Drive::truth(t)) * Drive::robotFromCamera();
    };
    start();
  }
  void start() {
    setup_ = setupWith(
        "[detection]\nenabled = false\n[tracking]\nclass = FakeOdometry\n[lidar]\nenabled = false\n");
    front_ = std::make_unique<FrontEnds>(setup_->stages, setup_->options);
  }
  Matrix6d covarianceOfAStep(const Matrix6d& of_camera) {
    fakes::world().step_covariance = of_camera;
    start();
    for (const double t : {0.0, 0.1}) front_->track(Drive::frame(t), {});
    return front_->motion().visual.between(0, 0.1, 0.01)->covariance;
  }
  std::unique_ptr<roomgraph::Setup> setup_;
  std::unique_ptr<FrontEnds> front_;
};

TEST_F(FrontEndsTest, WheelsPredictForTheCamera) {
  const Drive drive;
  for (const double t : {0.0, 0.1}) {
    ASSERT_TRUE(front_->add(drive.odometry(t)));
    front_->track(Drive::frame(t), {});
  }
  ASSERT_EQ(fakes::world().expected.size(), 2u);
  EXPECT_FALSE(fakes::world().expected[0]);
  ASSERT_TRUE(fakes::world().expected[1]);
  const auto camera = [&](double t) {
    return toPose3(drive.odometry(t).odom_from_robot) * Drive::robotFromCamera();
  };
  EXPECT_TRUE(fakes::world().expected[1]->isApprox(camera(0).inverse() * camera(0.1), 1e-9));
  EXPECT_EQ(fakes::world().by_scans, (std::vector<bool>{false, false}));
}

// The robot may have been carried.
TEST_F(FrontEndsTest, WheelsDoNotPredictOverAPause) {
  for (const double pause_s : {1.0, 5.0}) {
    start();
    fakes::world().expected.clear();
    for (const double t : {0.0, 0.1, 0.1 + pause_s}) {
      ASSERT_TRUE(front_->add({t, {0.02, 0, 0}}));
      front_->track(Drive::frame(t), {});
    }
    ASSERT_EQ(fakes::world().expected.size(), 3u);
    EXPECT_TRUE(fakes::world().expected[1]);
    EXPECT_EQ(fakes::world().expected[2].has_value(), pause_s < 2) << pause_s;
  }
}

TEST_F(FrontEndsTest, AHandheldCameraIsOnNoFloorWheelsAndMountedCamerasAre) {
  const auto onFloorAfter = [&](const auto& work) {
    start();
    EXPECT_FALSE(front_->motion().floor);
    work();
    return front_->motion().floor;
  };
  Frame handheld = Drive::frame(0);
  handheld.robot_from_camera = Pose3::Identity();
  EXPECT_FALSE(onFloorAfter([&] { front_->track(handheld, {}); }));
  EXPECT_TRUE(onFloorAfter([&] { front_->track(Drive::frame(0), {}); }));
  const auto floor = onFloorAfter([&] { front_->add(Drive().odometry(0)); });
  ASSERT_TRUE(floor);
  EXPECT_EQ(floor->sigma_z_m, setup_->options.backend.planar_sigma_z_m);
  EXPECT_EQ(floor->sigma_tilt_rad, setup_->options.backend.planar_sigma_tilt_rad);
}

TEST_F(FrontEndsTest, TheCameraIsToldWhenScansSawTheMovement) {
  setup_ = setupWith("[detection]\nenabled = false\n[tracking]\nclass = FakeOdometry\n");
  front_ = std::make_unique<FrontEnds>(setup_->stages, setup_->options);
  EXPECT_FALSE(front_->motion().floor);
  Drive drive;
  for (const double t : {0.0, 0.1, 0.2}) {
    ASSERT_TRUE(front_->match(drive.scan(t)).matched) << t;
    front_->track(Drive::frame(t), {});
  }
  EXPECT_EQ(fakes::world().by_scans, (std::vector<bool>{false, true, true}));
  EXPECT_TRUE(fakes::world().expected[2]);
}

double wheelsTurnTooFar(const FrontEnds& front, double from, double until) {
  const Pose2 moved = planarPart(front.motion().odometry.between(from, until, 0)->a_from_b), truth = Drive::truth(from).inverse() * Drive::truth(until);
  return wrapAngle(moved.yaw - truth.yaw);
}

TEST_F(FrontEndsTest, ErrorsOfWheelsAreTakenOutWhenTheyAreKnownAndInTheEndFromTheBeginning) {
  const Drive drive;
  const double too_far = 0.06 * 2 * M_PI / Drive::kLap_s;  // what wheels turn too far in a second
  const auto run = [&] {
    for (double t = 0; t < 10.05; t += 0.1) {
      front_->add(drive.odometry(t));
      front_->track(Drive::frame(t), {});
    }
  };
  run();
  EXPECT_GT(front_->wheelCalibration().compared(), 10);
  EXPECT_NEAR(wheelsTurnTooFar(*front_, 0, 1), too_far, 0.15 * too_far);
  EXPECT_NEAR(wheelsTurnTooFar(*front_, 8, 9), 0, 0.15 * too_far);
  front_->refine();
  EXPECT_NEAR(wheelsTurnTooFar(*front_, 0, 1), 0, 0.15 * too_far);

  setup_ = setupWith("[detection]\nenabled = false\n[tracking]\nclass = FakeOdometry\n[lidar]\nenabled = false\n[odometry]\ncalibrate = false\n");
  front_ = std::make_unique<FrontEnds>(setup_->stages, setup_->options);
  run();
  front_->refine();
  EXPECT_EQ(front_->wheelCalibration().compared(), 0);
  for (const double t : {0.0, 8.0}) EXPECT_NEAR(wheelsTurnTooFar(*front_, t, t + 1), too_far, 1e-9);
}

// Slow sensors say little of what was between two of their records.
TEST_F(FrontEndsTest, WheelsMayBeSlowerThanTheCameraAndASlowCameraIsNotCompared) {
  const Drive drive;
  for (int i = 0; i <= 100; ++i) {
    if (i % 2 == 0) front_->add(drive.odometry(0.1 * i));
    front_->track(Drive::frame(0.1 * i), {});
  }
  EXPECT_GT(front_->wheelCalibration().compared(), 10);

  start();
  for (int i = 0; i <= 400; ++i) {
    front_->add({0.1 * i, {0.03 * i, 0, 0}});
    if (i % 10 == 0) front_->track(Drive::frame(0.1 * i), {});
  }
  EXPECT_FALSE(front_->agreement().turned(MotionSensor::kCamera, MotionSensor::kWheels));
}

// Between two images that are two seconds apart nobody knows how a camera went round a bend.
TEST_F(FrontEndsTest, MovementsThatBeginInAGapAreNotCompared) {
  setup_ = setupWith(
      "[detection]\nenabled = false\n[tracking]\nclass = FakeOdometry\n"
      "[odometry]\nnoise_floor_m = 0.002\nnoise_per_m = 0.01\nnoise_floor_rad = 0.002\nnoise_per_rad = 0.01\nnoise_rad_per_m = 0.01\n");
  front_ = std::make_unique<FrontEnds>(setup_->stages, setup_->options);
  Drive drive;
  for (int i = 0; i <= 120; ++i) {
    const double t = 0.1 * i;
    front_->add(drive.odometry(t));
    ASSERT_TRUE(front_->match(drive.scan(t)).matched) << t;
    if (i % 43 < 20) front_->track(Drive::frame(t), {});
  }
  for (const Contradiction& one : front_->agreement().contradictions())
    ADD_FAILURE() << toString(one.sensor) << " from " << one.from_t << " by " << one.off_m << " m";
}

TEST_F(FrontEndsTest, SensorsAreComparedAndOneThatIsTurnedIsFound) {
  setup_ = setupWith("[detection]\nenabled = false\n[tracking]\nclass = FakeOdometry\n");
  fakes::world().world_from_camera = [](double t) {
    const Pose3 ahead = toPose3(Pose2{0.3 * t, 0, 0});
    return ahead * toPose3(Pose2{0, 0, 0.1}) * Drive::robotFromCamera();
  };
  front_ = std::make_unique<FrontEnds>(setup_->stages, setup_->options);
  for (double t = 0; t < 20; t += 0.1) {
    front_->add({t, {0.3 * t, 0, 0}});
    front_->track(Drive::frame(t), {});
  }
  const auto turned = front_->agreement().turned(MotionSensor::kCamera, MotionSensor::kWheels);
  ASSERT_TRUE(turned);
  EXPECT_NEAR(turned->rad, -0.1, 1e-6) << "ahead is to the right of where the camera was said to look";
  EXPECT_FALSE(front_->agreement().turned(MotionSensor::kCamera, MotionSensor::kLidar));
}

// A camera that is unsure along its optical axis means a robot that is unsure ahead.
TEST_F(FrontEndsTest, UncertaintyOfTheCameraIsTurnedIntoTheRobot) {
  Matrix6d of_camera = Matrix6d::Zero();
  of_camera.diagonal() << 1e-4, 2e-4, 9e-4, 3e-4, 4e-4, 5e-4;
  const Matrix6d difference = covarianceOfAStep(of_camera) - covarianceOfAStep(Matrix6d::Zero());
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = Drive::robotFromCamera().linear();
  const Matrix6d expected = turn * of_camera * turn.transpose();
  EXPECT_NEAR(expected(0, 0), 9e-4, 1e-12) << "the optical axis looks ahead";
  EXPECT_LT((difference - expected).norm(), 1e-9) << difference.diagonal().transpose();
}

TEST_F(FrontEndsTest, ImagesConfirmClosuresBetweenRobots) {
  for (double t = 0; t < 5.05; t += 0.1) front_->track(Drive::frame(t), {});
  RelativePose proposed;
  proposed.t_a = 1;
  proposed.t_b = 5;
  const Pose3 truth = toPose3(Drive::truth(1).inverse() * Drive::truth(5));
  proposed.a_from_b = truth * poseFromYpr(0.1, -0.1, 0, 0.05, 0, 0);
  const auto closure = front_->verify(proposed);
  ASSERT_TRUE(closure);
  EXPECT_TRUE(closure->a_from_b.isApprox(truth, 1e-6));
}

// Links between segments are movements.
TEST_F(FrontEndsTest, LinksAreNotCountedAmongLoopClosures) {
  const auto seen = [](double t_a, double t_b) {
    const auto& camera = fakes::world().world_from_camera;
    RelativePose out{t_a, t_b, camera(t_a).inverse() * camera(t_b), 1e-6 * Matrix6d::Identity()};
    out.source = "tracking";
    return out;
  };
  SemanticSlam slam(std::move(setup_));
  for (double t = 0; t < 5.05; t += 0.1) slam.process(Drive::frame(t));
  RelativePose link = seen(3, 4);
  link.link = true;
  fakes::world().closures = {seen(1, 4.5), link};
  for (double t = 5.1; t < 8.05; t += 0.1) slam.process(Drive::frame(t));
  const SlamResult result = slam.finish();
  EXPECT_EQ(result.counts.loop_closures, 1);
  EXPECT_EQ(result.counts.links, 1);
}

}  // namespace
}  // namespace roomgraph::test
