// SPDX-License-Identifier: BSD-3-Clause
// Ground and proposals of a frame: beside its tracking where they do not need its pose.
#include <opencv2/core/utility.hpp>

#include "moving_in_depth.h"
#include "roomgraph/observations/mounting.h"
#include "roomgraph/pipeline/semantic_slam.h"

namespace roomgraph {
namespace {
constexpr double kPlacedWithin_s = 0.3;  // a source whose last pose is so old still places a frame
}  // namespace

// On a robot the floor is where the extrinsics say.
std::future<SemanticSlam::Proposed> SemanticSlam::propose(const Frame& frame, const std::vector<Detection>& detections) {
  const bool needs_pose = !isMounted(frame) || estimator_.levelled();
  const bool beside = !needs_pose && cv::getNumThreads() > 1;
  return std::async(beside ? std::launch::async : std::launch::deferred, [this, &frame, &detections] {
    const Meter meter;
    FrameProposals proposals = setup_->stages.proposal_generator->generate(frame, detections, seeGround(frame));
    return Proposed{std::move(proposals), meter.soFar()};
  });
}

FrameProposals SemanticSlam::take(std::future<Proposed>& proposing) {
  Proposed proposed = proposing.get();
  times_.add("proposals", proposed.work);
  if (!proposed.proposals.ground) ++counts_.reasons["ground: " + proposed.proposals.ground_reason];
  return std::move(proposed.proposals);
}

FrameGround SemanticSlam::seeGround(const Frame& frame) {
  std::optional<Plane> expected;
  if (isMounted(frame)) expected = groundInCamera(frame.robot_from_camera);
  if (estimator_.levelled())
    expected = groundInCamera(estimator_.poses().at(frame.t) * frame.robot_from_camera);
  GroundDetector& detector = *setup_->stages.ground_detector;
  FrameGround ground = groundOf(frame, expected, detector);
  if (estimator_.planar() || (ground.estimate && ground.estimate->from_depth && expected)) return ground;
  // A handheld camera whose floor is not known yet, or is not where it should be.
  const FrameGround anywhere = expected ? groundOf(frame, std::nullopt, detector) : ground;
  if (anywhere.estimate && findFloor(frame, anywhere.estimate->plane)) return seeGround(frame);
  if (!expected && ground.estimate)
    return {std::nullopt, "a plane that few frames have seen may be no floor"};
  return ground;
}

bool SemanticSlam::placedByOthers(double t) const {
  const Motion& motion = front_ends_.motion();
  const auto saw = [t](const MotionSource& source) { return source.between(t - kPlacedWithin_s, t, kPlacedWithin_s).has_value(); };
  return saw(motion.odometry) || saw(motion.lidar);
}

bool SemanticSlam::isPlaced(const Frame& frame, const TrackingResult& tracked) const {
  return tracked.tracked || !setup_->stages.rgbd_odometry || placedByOthers(frame.t);
}

// What moves is told in the tracker's frame: in world poses jump where loops close.
void SemanticSlam::drawDepth(const Frame& frame, const Plane& floor, const std::vector<Box2>& people, const TrackingResult& tracked) {
  const bool tracks = setup_->stages.rgbd_odometry != nullptr;
  auto slice = mapper_.slice(frame, floor, people);
  if (!slice) return;
  if (setup_->options.mapping.leave_out_moving && mapper_.drawsDepth(frame.t) && (tracked.tracked || !tracks)) {
    const Pose3 robot = tracks ? tracked.odom_from_camera * frame.robot_from_camera.inverse() : estimator_.poses().at(frame.t);
    counts_.returns_in_free_space += moving_->leaveOut(*slice, robot, tracked.segment);
  }
  mapper_.add(std::move(*slice));
}

// Where the floor is not where it should be it is sought wherever it is: the recorded pose may be wrong. The front ends, which know the
// camera by its name, must have seen it.
void SemanticSlam::watchTilt(const Frame& frame, const std::optional<GroundEstimate>& where_expected) {
  const Pose2 robot = planarPart(estimator_.poses().at(frame.t));
  if (!isMounted(frame) || !setup_->stages.rgbd_odometry || !tilt_.wants(frame.t, robot)) return;
  const bool there = where_expected && where_expected->from_depth;
  const auto seen = there ? where_expected : groundOf(frame, std::nullopt, *setup_->stages.ground_detector).estimate;
  const auto in_robot = seen ? std::optional(transformed(frame.robot_from_camera, seen->plane)) : std::nullopt;
  tilt_.add(frame.t, robot, in_robot, frame.robot_from_camera.translation());
}

// Levels the world by a floor that several frames agree on; returns whether it did.
bool SemanticSlam::findFloor(const Frame& frame, const Plane& in_camera) {
  const Pose3 world_from_camera = estimator_.poses().at(frame.t) * frame.robot_from_camera;
  const Plane in_world = transformed(world_from_camera, in_camera);
  const bool again = estimator_.levelled();
  if (again && !contradictsFloor(in_world, world_from_camera.translation())) return false;
  // The floor is where it was; the pose of a frame that nothing placed is wrong.
  if (again && setup_->stages.rgbd_odometry && placed_t_ != frame.t && !placedByOthers(frame.t)) return false;
  const auto floor = floors_.add(frame.t, in_world, world_from_camera.translation());
  if (!floor) return false;
  if (again) ++counts_.reasons["ground: what was taken for the floor was none"];
  objects_.move(estimator_.level(*floor));
  floors_.clear();
  return true;
}

}  // namespace roomgraph
