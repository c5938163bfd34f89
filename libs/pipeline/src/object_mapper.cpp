// SPDX-License-Identifier: BSD-3-Clause
// Measurements in world, negative evidence from misses and beams, merging and splitting of landmarks.
#include "roomgraph/pipeline/object_mapper.h"

#include <algorithm>
#include <set>

#include "roomgraph/association/reassociation.h"
#include "roomgraph/geometry/ground.h"
#include "roomgraph/geometry/place_covariance.h"
#include "visibility.h"

namespace roomgraph {
namespace {

constexpr double kRayDistance_m = 0.2, kRayAngle_rad = 0.2;  // scans from one place say the same

// Proposal covariances are in the ground frame under the camera (x ahead, y left, z up): turn them by its
// heading.
WorldMeasurement toWorld(const ObjectMeasurement& measurement, const PinholeCamera& camera,
                         const Pose3& world_from_camera, double pose_sigma_m) {
  WorldMeasurement out{measurement, world_from_camera * measurement.proposal.camera_from_object, {}, camera};
  const Pose3 world_from_ground = world_from_camera * cameraFromGround(groundInCamera(world_from_camera));
  const double heading = planarPart(world_from_ground).yaw;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(heading).toRotationMatrix();
  out.covariance = turned(measurement.proposal.covariance, turn);
  out.covariance.topLeftCorner<2, 2>() += pose_sigma_m * pose_sigma_m * Eigen::Matrix2d::Identity();
  return out;
}

// Two landmarks were one: their shares of the posterior belong together.
void rename(ObjectDecision& decision, LandmarkId removed, LandmarkId kept) {
  if (decision.landmark == removed) decision.landmark = kept;
  if (decision.association.landmark == removed) decision.association.landmark = kept;
  auto& posterior = decision.association.posterior;
  const auto find = [&](LandmarkId id) {
    return std::find_if(posterior.begin(), posterior.end(), [id](const auto& p) { return p.first == id; });
  };
  const auto old = find(removed);
  if (old == posterior.end()) return;
  if (const auto other = find(kept); other != posterior.end()) {
    other->second = std::min(1.0, other->second + old->second);  // rounding
    posterior.erase(old);
  } else {
    old->first = kept;
  }
}

// Those with depth; the mapper remembers no more of the others than which object they lie on.
std::vector<FeatureTrack> featuresOnObjects(const std::vector<ObjectDecision>& decisions,
                                            const std::vector<FeatureTrack>& features) {
  std::set<std::int64_t> on_objects;
  for (const auto& decision : decisions)
    on_objects.insert(decision.seen.measurement.features.begin(), decision.seen.measurement.features.end());
  std::vector<FeatureTrack> out;
  for (const auto& feature : features)
    if (feature.depth_m > 0 && on_objects.contains(feature.point)) out.push_back(feature);
  return out;
}

}  // namespace

std::vector<ObjectDecision> ObjectMapper::observe(const FrameProposals& seen, const Frame& frame,
                                                  const std::vector<FeatureTrack>& features) {
  const auto measurements = select(seen, frame, features);
  std::vector<ObjectDecision> decisions;
  for (const auto& association : stages_.associator->associate(measurements, landmarks().landmarks())) {
    ObjectDecision decision{measurements[association.measurement], association, {}};
    decision.landmark = landmarks().update(decision.seen, association);
    stages_.associator->assigned(decision.seen, decision.landmark);
    decision.seen.measurement.detection.mask = cv::Mat();  // large, and not needed any more
    decisions.push_back(std::move(decision));
  }
  if (decisions.empty()) return decisions;
  frames_.push_back({frame.id, frame.t, frame.camera, frame.robot_from_camera, decisions,
                     featuresOnObjects(decisions, features)});
  span(frames_.back());
  return decisions;
}

std::vector<WorldMeasurement> ObjectMapper::select(const FrameProposals& seen, const Frame& frame,
                                                   const std::vector<FeatureTrack>& features) const {
  const Pose3 world_from_camera = poses_.at(frame.t) * frame.robot_from_camera;
  std::vector<WorldMeasurement> out;
  for (const auto& chosen :
       stages_.proposal_selector->select(seen, {frame.camera, world_from_camera, features})) {
    const auto* model = stages_.database.find(chosen.proposal.class_name);
    if (model && model->landmark)
      out.push_back(toWorld(chosen, frame.camera, world_from_camera, stages_.backend.pose_sigma_m));
  }
  return out;
}

void ObjectMapper::missUnseen(const std::vector<ObjectDecision>& decisions,
                              const std::vector<Detection>& detections, const Frame& frame) {
  std::set<LandmarkId> seen;
  for (const auto& decision : decisions) seen.insert(decision.landmark);
  const Pose3 world_from_camera = poses_.at(frame.t) * frame.robot_from_camera;
  std::vector<LandmarkId> missed;
  for (const auto& landmark : landmarks().landmarks())
    if (!seen.contains(landmark.id) && shouldBeSeen(landmark, frame, world_from_camera, detections))
      missed.push_back(landmark.id);
  for (const auto id : missed) landmarks().miss(id);
}

void ObjectMapper::observe(const Scan& scan, const Pose3& world_from_robot) {
  if (last_rays_from_) {
    const Pose3 moved = last_rays_from_->inverse() * world_from_robot;
    if (moved.translation().norm() < kRayDistance_m && rotationAngle(moved) < kRayAngle_rad) return;
  }
  last_rays_from_ = world_from_robot;
  for (const Landmark& landmark : std::vector<Landmark>(landmarks().landmarks())) {
    const ObjectModel* model = stages_.database.find(landmark.model);
    const RayEvidence rays = rayEvidence(landmark, scan, world_from_robot, model ? model->solid_share : 0);
    if (rays.inside > 0) {
      landmarks().supported(landmark.id, rays.inside);
    } else if (rays.through > 0) {
      landmarks().seenThrough(landmark.id, rays.through);
    }
  }
}

void ObjectMapper::tidy() {
  const auto parted = landmarks().splitMixed();
  for (const auto& [first, second] : parted) shareSightings(first, second);
  const auto merged = landmarks().mergeDuplicates();
  for (const auto& [removed, kept] : merged) {
    stages_.associator->merged(removed, kept);
    for (auto& frame : frames_)
      for (auto& decision : frame.decisions) rename(decision, removed, kept);
  }
  if (!merged.empty() || !parted.empty()) respan();
}

// A landmark became two: what was seen of it belongs to the nearer one.
void ObjectMapper::shareSightings(LandmarkId first, LandmarkId second) {
  const Eigen::Vector3d first_place = landmarks().find(first)->position;
  const Eigen::Vector3d second_place = landmarks().find(second)->position;
  for (auto& frame : frames_) {
    const Pose3 world_from_camera = poses_.at(frame.t) * frame.robot_from_camera;  // poses have moved since
    for (auto& decision : frame.decisions) {
      if (decision.landmark != first) continue;
      const Eigen::Vector3d place =
          (world_from_camera * decision.seen.measurement.proposal.camera_from_object).translation();
      if ((place - second_place).norm() < (place - first_place).norm()) rename(decision, first, second);
    }
  }
}

std::vector<std::vector<WorldMeasurement>> ObjectMapper::measurementsInWorld() const {
  std::vector<std::vector<WorldMeasurement>> out;
  for (const auto& frame : frames_) {
    const Pose3 world_from_camera = poses_.at(frame.t) * frame.robot_from_camera;
    out.emplace_back();
    for (const auto& decision : frame.decisions)
      out.back().push_back(
          toWorld(decision.seen.measurement, frame.camera, world_from_camera, stages_.backend.pose_sigma_m));
  }
  return out;
}

bool ObjectMapper::reassociate() {
  const AssociationModel* model = stages_.associator->model();
  if (!model || frames_.empty()) return false;
  const auto by_frame = measurementsInWorld();
  const Reassociation result =
      roomgraph::reassociate(by_frame, landmarks().landmarks(), *model, landmarks().duplicates());
  landmarks().adopt(by_frame, result);
  bool changed = false;
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    for (std::size_t k = 0; k < by_frame[f].size(); ++k) {
      ObjectDecision& decision = frames_[f].decisions[k];
      const BatchDecision& now = result.decisions[f][k];
      changed |= decision.landmark != now.landmark;
      decision = {by_frame[f][k], now.association, now.landmark};
    }
  }
  respan();
  return changed;
}

void ObjectMapper::moveSince(double t, const Pose3& new_from_old) {
  for (const auto& [id, span] : spans_)
    if (span.first >= t) landmarks().move(id, new_from_old);
}

ObjectFactors ObjectMapper::factors() const {
  const AssociationModel* model = stages_.associator->model();
  return objectFactors(frames_, poses_, landmarks().landmarks(), stages_.database, stages_.backend,
                       model ? &model->measurement : nullptr);
}

void ObjectMapper::respan() {
  spans_.clear();
  for (const auto& frame : frames_) span(frame);
}

void ObjectMapper::span(const ObjectFrame& frame) {
  for (const auto& decision : frame.decisions)
    spans_.try_emplace(decision.landmark, SeenSpan{frame.t, frame.t}).first->second.last = frame.t;
}

}  // namespace roomgraph
