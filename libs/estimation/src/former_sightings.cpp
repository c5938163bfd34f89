// SPDX-License-Identifier: BSD-3-Clause
// ObjectMapper: which sightings are given up or forgotten, what is kept of them, and whose they are after a re-association.
#include <algorithm>
#include <set>

#include "measurement_in_world.h"
#include "moved_landmarks.h"
#include "roomgraph/association/landmark_rules.h"
#include "roomgraph/association/reassociation.h"
#include "roomgraph/estimation/object_mapper.h"
#include "space_memory.h"

namespace roomgraph {
namespace {

constexpr ViewLimits kSightings{.of_a_view = 16};  // they scatter more than depths do
constexpr int kLeastSightings = 40;                // of a landmark that are kept
constexpr double kNearHome_m = 0.7;
constexpr double kDrifts = 4;  // standard deviations

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

// All would seem moved by the drift from one visit to the other: that of either against now adds up to more.
bool maySeemSo(const ChangeOfPlace& change, const Drift& drift, const KeyPoses& poses) {
  double variance = 0;  // m^2
  for (const double t : {change.since_t, change.last_t, change.first_t}) variance += drift.variance(poses, t, change.after);
  return (change.after - change.before).squaredNorm() < kDrifts * kDrifts * variance;
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

void ObjectMapper::followMoved(const Drift& drift, double since_t) {
  auto said = movedLandmarks(landmarks_.landmarks(), frames_, poses_, since_t);
  std::erase_if(said, [&](const MovedLandmark& moved) { return maySeemSo(moved.change, drift, poses_); });
  if (said.empty()) return;
  const PosedViews views = space_->posed(poses_);
  std::set<LandmarkId> followed;
  for (const auto& [id, same, change] : said) {
    if (followed.contains(id) || (same && followed.contains(*same)) || !raysAgree(*landmarks_.find(id), change, views)) continue;
    followed.insert(id);
    if (same) followed.insert(*same);
    landmarks_.setMoved(id, same, change.after);
    if (same) renameSightings();
    moved_.emplace_back(id, change.first_t);
    forgetBefore(change.first_t, id);
  }
  respan();
}

// Not when a landmark that was seen before became part of it.
std::optional<double> ObjectMapper::standsSince(LandmarkId id) const {
  std::optional<double> out;
  for (const auto& [then, t] : moved_)
    if (landmarks_.identity().today(then) == id) out = std::max(out, std::optional(t));
  const auto span = spans_.find(id);
  return out && span != spans_.end() && span->second.first >= *out ? out : std::nullopt;
}

std::vector<Landmark> ObjectMapper::landmarksNow() const {
  std::vector<Landmark> out = landmarks_.landmarks();
  for (Landmark& landmark : out) landmark.stands_since = standsSince(landmark.id);
  return out;
}

void ObjectMapper::forgetBefore(double t, LandmarkId landmark) {
  std::vector<std::size_t> without;
  for (std::size_t i = 0; i < frames_.size() && frames_[i].t < t; ++i) {
    const auto is = [landmark](const ObjectDecision& decision) { return decision.landmark == landmark; };
    if (std::none_of(frames_[i].decisions.begin(), frames_[i].decisions.end(), is)) continue;
    std::erase_if(frames_.change(i).decisions, is);
    if (frames_[i].decisions.empty()) without.push_back(i);
  }
  frames_.giveUp(without, {});
  std::erase_if(frames_.changeFormer(), [&](const FormerSighting& sighting) { return sighting.landmark == landmark && sighting.t < t; });
}

void ObjectMapper::findHomes(const Reassociation& result) {
  for (auto& sighting : frames_.changeFormer()) sighting.landmark = homeOf(sighting, result, poses_);
}

}  // namespace roomgraph
