// SPDX-License-Identifier: BSD-3-Clause
// ObjectMapper: which sightings are given up, what is kept of them, and whose they are after a re-association.
#include <algorithm>

#include "measurement_in_world.h"
#include "roomgraph/association/landmark_rules.h"
#include "roomgraph/association/reassociation.h"
#include "roomgraph/estimation/object_mapper.h"
#include "space_memory.h"

namespace roomgraph {
namespace {

constexpr ViewLimits kSightings{.of_a_view = 16};  // they scatter more than depths do
constexpr int kLeastSightings = 40;                // of a landmark that are kept
constexpr double kNearHome_m = 0.7;

// Whether all its landmarks have sightings to spare; the frame's own are taken off then.
bool spares(const ObjectFrame& frame, std::map<LandmarkId, int>& sightings) {
  const auto has = [&](const ObjectDecision& decision) { return sightings[decision.landmark] > kLeastSightings; };
  if (!std::all_of(frame.decisions.begin(), frame.decisions.end(), has)) return false;
  for (const auto& decision : frame.decisions) --sightings[decision.landmark];
  return true;
}

// The landmark of a former sighting after a re-association; of one that lost all its other sightings the nearest of the class.
LandmarkId homeOf(const FormerSighting& sighting, const Reassociation& result, const KeyPoses& poses) {
  const LandmarkId today = result.identity.today(sighting.landmark);
  const Eigen::Vector3d place = poses.at(sighting.t) * sighting.place_in_robot;
  LandmarkId nearest = today;
  double least_m = kNearHome_m;
  for (const Landmark& landmark : result.landmarks) {
    if (landmark.id == today) return today;
    const double distance = (landmark.position - place).head<2>().norm();
    if (landmark.class_name == sighting.class_name && distance < least_m) nearest = landmark.id, least_m = distance;
  }
  return nearest;
}

}  // namespace

void ObjectMapper::giveUpRepeated(std::size_t kept, const Trajectory& until_lately) {
  space_->giveUpRepeated(kept, until_lately);
  if (!frames_watch_.due(frames_.size(), kept)) return;
  std::vector<double> times;
  for (const auto& frame : frames_) times.push_back(frame.t);
  auto repeated = repeatedViews(times, until_lately, kSightings);
  std::map<LandmarkId, int> sightings;
  for (const auto& frame : frames_)
    for (const auto& decision : frame.decisions) ++sightings[decision.landmark];
  std::erase_if(repeated, [&](std::size_t i) { return !spares(frames_[i], sightings); });
  std::vector<FormerSighting> known;
  for (const std::size_t i : repeated)
    for (const auto& decision : frames_[i].decisions) known.push_back(former(frames_[i], decision));
  frames_.giveUp(repeated, known);
  frames_watch_.done(frames_.size());
}

FormerSighting ObjectMapper::former(const ObjectFrame& frame, const ObjectDecision& decision) const {
  const ObjectMeasurement& measurement = decision.seen.measurement;
  // Where it would be seen by the poses of now, as in reassociate().
  const Pose3 world_from_camera = poses_.at(frame.t) * frame.robot_from_camera;
  const WorldMeasurement now = measurementInWorld(measurement, frame.camera, world_from_camera, pose_sigma_m_);
  return {.t = frame.t,
          .frame = frame.frame,
          .class_name = measurement.proposal.class_name,
          .box = measurement.detection.box,
          .landmark = decision.landmark,
          .probability = decision.association.probability,
          .existence_log_ratio = landmarks_.existenceLogRatio(decision.landmark, now),
          .weight = sightingWeight(measurement),
          .place_in_robot = (frame.robot_from_camera * measurement.proposal.camera_from_object).translation()};
}

void ObjectMapper::findHomes(const Reassociation& result) {
  for (auto& sighting : frames_.changeFormer()) sighting.landmark = homeOf(sighting, result, poses_);
}

}  // namespace roomgraph
