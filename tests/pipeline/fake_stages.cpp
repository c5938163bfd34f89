// SPDX-License-Identifier: BSD-3-Clause
// Exact boxes, proposals, movement and closures from the true world of a test.
#include "fake_stages.h"

#include "roomgraph/geometry/projection.h"

namespace fakes {

IMPLEMENTS_MRPT_OBJECT(FakeDetector, roomgraph::Detector, fakes)
IMPLEMENTS_MRPT_OBJECT(FakeFloors, roomgraph::GroundDetector, fakes)
IMPLEMENTS_MRPT_OBJECT(FakeProposals, roomgraph::ProposalGenerator, fakes)
IMPLEMENTS_MRPT_OBJECT(FakeOdometry, roomgraph::RgbdOdometry, fakes)
IMPLEMENTS_MRPT_OBJECT(FakeAssociator, roomgraph::Associator, fakes)

using namespace roomgraph;

World& world() {
  static World instance;
  return instance;
}

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(FakeDetector, fakes));
  mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(FakeFloors, fakes));
  mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(FakeProposals, fakes));
  mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(FakeOdometry, fakes));
  mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(FakeAssociator, fakes));
}

namespace {

Pose3 cameraFromObject(const WorldObject& object, double t) {
  return world().world_from_camera(t).inverse() * object.world_from_object;
}

void noteQuestion() {
  if (world().releases > 0) world().asked_after_release = true;
}

}  // namespace

Outcome<std::vector<Detection>> FakeDetector::detect(const Frame& frame) {
  ++world().detector_calls;
  if (frame.t >= world().detector_fails_from) return Outcome<std::vector<Detection>>::failure("not this frame");
  std::vector<Detection> found;
  for (const auto& object : world().objects) {
    const Pose3 camera_from_object = cameraFromObject(object, frame.t);
    if (camera_from_object.translation().z() < 0.8) continue;
    const auto projected = projectShape(object.shape, camera_from_object, frame.camera);
    if (!projected) continue;
    Detection detection;
    detection.class_name = detection.label = object.class_name;
    detection.box = projected->visible;
    detection.score = 0.9;
    found.push_back(detection);
  }
  return found;
}

Outcome<GroundEstimate> FakeFloors::detect(const Frame& frame, const std::optional<Plane>& expected) {
  Pose3 above = world().world_from_camera(frame.t);
  above.translation().z() -= world().plane_height(frame.t);
  const Plane plane = groundInCamera(above);
  if (expected && (std::abs(expected->offset - plane.offset) > 0.12 ||
                   expected->normal.dot(plane.normal) < std::cos(0.1)))
    return Outcome<GroundEstimate>::failure("elsewhere");
  return GroundEstimate{plane, 1e-6 * Eigen::Matrix4d::Identity(), true};
}

FrameProposals FakeProposals::generate(const Frame& frame, const std::vector<Detection>& detections,
                                       const FrameGround&) {
  if (world().while_proposing) world().while_proposing();
  FrameProposals out;
  out.frame = frame.id;
  out.t = frame.t;
  out.detections = detections;
  GroundEstimate ground;
  ground.plane = groundInCamera(world().world_from_camera(frame.t));
  ground.from_depth = true;
  out.ground = ground;
  for (std::size_t j = 0; j < detections.size(); ++j)
    for (const auto& object : world().objects) {
      const auto seen = projectShape(object.shape, cameraFromObject(object, frame.t), frame.camera);
      if (object.class_name != detections[j].class_name || !seen || !(seen->visible == detections[j].box))
        continue;
      Proposal proposal;
      proposal.detection = static_cast<int>(j);
      proposal.model = proposal.class_name = object.class_name;
      proposal.shape = object.shape;
      proposal.camera_from_object = cameraFromObject(object, frame.t);
      proposal.covariance = 0.02 * 0.02 * Eigen::Matrix4d::Identity();
      proposal.has_yaw = object.shape.kind != ShapeKind::kCylinder;
      proposal.projected.full = proposal.projected.visible = detections[j].box;
      proposal.score = proposal.box_iou = 1;
      proposal.size_information.setConstant(1e8);
      out.proposals.push_back(proposal);
    }
  return out;
}

std::vector<Association> FakeAssociator::associate(const std::vector<WorldMeasurement>& measurements,
                                                   const std::vector<Landmark>& landmarks) {
  std::vector<Association> out;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const LandmarkId id = i == 0 && !landmarks.empty() ? landmarks.front().id : LandmarkId{};
    out.push_back({.measurement = i, .landmark = id, .probability = 0.6, .posterior = {{id, 0.6}}});
  }
  return out;
}

Trajectory FakeOdometry::trajectory() const {
  noteQuestion();
  return trajectory_;
}

std::vector<RelativePose> FakeOdometry::takeLoopClosures() {
  noteQuestion();
  return std::exchange(world().closures, {});
}

TrackingResult FakeOdometry::track(const Frame& frame, const TrackingPrior& prior) {
  noteQuestion();
  if (world().while_tracking) world().while_tracking();
  world().masked.push_back(prior.dynamic_regions);
  world().expected.push_back(prior.previous_from_current);
  world().by_scans.push_back(prior.by_scans);
  TrackingResult result;
  if (frame.t >= world().not_tracked.first && frame.t < world().not_tracked.second) {
    result.reason = "too few features";
    return result;
  }
  result.tracked = true;
  // A frame of its own, as a real tracker has.
  result.odom_from_camera = poseFromYpr(4, 5, 6, 0.3, 0, 0) * world().world_from_camera(frame.t);
  result.step_covariance = world().step_covariance;
  result.segment = frame.t >= world().lost_at;
  trajectory_.add(frame.t, result.odom_from_camera, result.segment);
  return result;
}

std::optional<RelativePose> FakeOdometry::verifyLoop(const RelativePose& proposed) {
  noteQuestion();
  RelativePose exact = proposed;
  exact.a_from_b =
      world().world_from_camera(proposed.t_a).inverse() * world().world_from_camera(proposed.t_b);
  if ((exact.a_from_b.translation() - proposed.a_from_b.translation()).norm() > 1) return std::nullopt;
  exact.covariance = 1e-6 * Matrix6d::Identity();
  return exact;
}

}  // namespace fakes
