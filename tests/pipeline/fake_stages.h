// SPDX-License-Identifier: BSD-3-Clause
// Detector, proposal generator and odometry that know the truth, an associator that errs, chosen by class
// name.
#pragma once

#include <functional>
#include <vector>
#include <utility>

#include "roomgraph/association/association_model.h"
#include "roomgraph/association/associator.h"
#include "roomgraph/detection/detector.h"
#include "roomgraph/proposals/ground_detector.h"
#include "roomgraph/proposals/proposal_generator.h"
#include "roomgraph/tracking/rgbd_odometry.h"

// Stages that know the truth, to test what lies between them. Chosen by class name, as any other.
namespace fakes {

struct WorldObject {
  std::string class_name;
  roomgraph::ObjectShape shape;
  roomgraph::Pose3 world_from_object = roomgraph::Pose3::Identity();
};

/// What is true in the running test.
struct World {
  std::function<roomgraph::Pose3(double)> world_from_camera;
  std::vector<WorldObject> objects;
  double lost_at = 1e300;              ///< from then on the odometry counts in a new segment
  std::pair<double, double> not_tracked = {1e300, 1e300};  ///< the odometry sees nothing from the one to the other
  double detector_fails_from = 1e300;  ///< from then on the detector does not run
  /// Above the floor, of the level plane that the depth camera sees, by time.
  std::function<double(double)> plane_height = [](double) { return 0.0; };
  std::vector<roomgraph::RelativePose> closures = {};  ///< between cameras; the odometry gives them once
  roomgraph::Matrix6d step_covariance = 1e-8 * roomgraph::Matrix6d::Identity();  ///< that the odometry says
  /// What came of the run: what the tracker was told to leave out and to expect, frame by frame; detector's
  /// calls.
  std::vector<std::vector<roomgraph::Box2>> masked = {};
  std::vector<std::optional<roomgraph::Pose3>> expected = {};
  std::vector<bool> by_scans = {};  ///< whether those movements were
  int releases = 0;                 ///< of the odometry
  bool asked_after_release = false;
  int detector_calls = 0;
  /// Called by the odometry and by the proposal generator. May be empty.
  std::function<void()> while_tracking = {}, while_proposing = {};
};
World& world();

void registerClasses();

/// Exact boxes of all objects in view.
class FakeDetector : public roomgraph::Detector {
  DEFINE_MRPT_OBJECT(FakeDetector, fakes)
 public:
  void setDatabase(const roomgraph::ObjectDatabase&) override {}
  roomgraph::Outcome<std::vector<roomgraph::Detection>> detect(const roomgraph::Frame& frame) override;
};

/// Sees exactly the plane of the world, unless one is expected elsewhere.
class FakeFloors : public roomgraph::GroundDetector {
  DEFINE_MRPT_OBJECT(FakeFloors, fakes)
 public:
  roomgraph::Outcome<roomgraph::GroundEstimate> detect(
      const roomgraph::Frame& frame, const std::optional<roomgraph::Plane>& expected) override;
};

/// Exact shapes and places of the detected objects, and the exact floor.
class FakeProposals : public roomgraph::ProposalGenerator {
  DEFINE_MRPT_OBJECT(FakeProposals, fakes)
 public:
  void setDatabase(const roomgraph::ObjectDatabase&) override {}
  roomgraph::FrameProposals generate(const roomgraph::Frame& frame,
                                     const std::vector<roomgraph::Detection>& detections,
                                     const roomgraph::FrameGround& ground) override;
};

/// Takes all measurements for the first landmark, one in each frame, and is not sure; its model knows better.
class FakeAssociator : public roomgraph::Associator {
  DEFINE_MRPT_OBJECT(FakeAssociator, fakes)
 public:
  std::vector<roomgraph::Association> associate(const std::vector<roomgraph::WorldMeasurement>& measurements,
                                                const std::vector<roomgraph::Landmark>& landmarks) override;
  const roomgraph::AssociationModel* model() const override { return &model_; }

 private:
  roomgraph::AssociationModel model_;
};

/// The exact movement of the camera.
class FakeOdometry : public roomgraph::RgbdOdometry {
  DEFINE_MRPT_OBJECT(FakeOdometry, fakes)
 public:
  roomgraph::TrackingResult track(const roomgraph::Frame& frame,
                                  const roomgraph::TrackingPrior& prior) override;
  roomgraph::Trajectory trajectory() const override;
  std::vector<roomgraph::RelativePose> takeLoopClosures() override;
  /// Confirms what is proposed with an error of less than 1 m, and gives the exact closure.
  std::optional<roomgraph::RelativePose> verifyLoop(const roomgraph::RelativePose& proposed) override;
  void release() override { ++world().releases; }

 private:
  roomgraph::Trajectory trajectory_;
};

}  // namespace fakes
