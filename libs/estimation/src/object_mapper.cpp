// SPDX-License-Identifier: BSD-3-Clause
// Association and fusion of measurements, evidence of misses and beams, merging and splitting of landmarks.
#include "roomgraph/estimation/object_mapper.h"

#include <algorithm>
#include <functional>
#include <set>

#include "existence_evidence.h"
#include "measurement_in_world.h"
#include "roomgraph/association/landmark_identity.h"
#include "roomgraph/association/reassociation.h"
#include "scan_sides.h"
#include "space_memory.h"
#include "visibility.h"

namespace roomgraph {
namespace {

constexpr double kScanAge_s = 0.3;     // of a scan that an image is compared with
constexpr double kLeastDoubted = 0.2;  // share of its score that a shape keeps which all beams pass through
constexpr double kRayDistance_m = 0.2, kRayAngle_rad = 0.2;  // scans from one place repeat each other

void rename(ObjectDecision& decision, const std::function<LandmarkId(LandmarkId)>& id_today) {
  decision.landmark = id_today(decision.landmark);
  decision.association.landmark = id_today(decision.association.landmark);
  decision.association.posterior = renamed(decision.association.posterior, id_today);
}

// Whether it names a landmark that has another id today.
bool isOutdated(const ObjectDecision& decision, const LandmarkIdentity& identity) {
  const auto has_other = [&](LandmarkId id) { return identity.today(id) != id; };
  const auto& posterior = decision.association.posterior;
  return has_other(decision.landmark) || has_other(decision.association.landmark) ||
         std::any_of(posterior.begin(), posterior.end(), [&](const auto& weighted) { return has_other(weighted.first); });
}

// Features with depth; of the others only their object is stored.
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

ObjectMapper::ObjectMapper(std::shared_ptr<Associator> associator, const LandmarkOptions& options,
                           double pose_sigma_m, const KeyPoses& poses)
    : associator_(std::move(associator)),
      landmarks_(options),
      pose_sigma_m_(pose_sigma_m),
      hindsight_(options.hindsight),
      poses_(poses),
      space_(std::make_unique<SpaceMemory>()) {}

ObjectMapper::~ObjectMapper() = default;

// Of the place of each landmark as the robot sees it now, m^2.
std::map<LandmarkId, double> ObjectMapper::driftVariances(const Drift& drift) const {
  std::map<LandmarkId, double> out;
  for (const auto& landmark : landmarks_.landmarks())
    if (const auto span = spans_.find(landmark.id); span != spans_.end())
      out[landmark.id] = drift.variance(poses_, span->second.last, landmark.position.head<2>());
  return out;
}

std::vector<ObjectDecision> ObjectMapper::associate(const std::vector<ObjectMeasurement>& measurements,
                                                    const Frame& frame,
                                                    const std::vector<FeatureTrack>& features,
                                                    const Drift& drift) {
  const Pose3 world_from_camera = poses_.at(frame.t) * frame.robot_from_camera;
  std::vector<WorldMeasurement> in_world;
  for (const auto& measurement : measurements)
    in_world.push_back(measurementInWorld(measurement, frame.camera, world_from_camera, pose_sigma_m_));
  const auto drifted = driftVariances(drift);
  std::vector<Landmark> as_seen_now = landmarks_.landmarks();
  for (Landmark& landmark : as_seen_now)
    if (const auto found = drifted.find(landmark.id); found != drifted.end())
      landmark.covariance.diagonal().head<2>().array() += found->second;
  std::vector<ObjectDecision> decisions;
  for (const auto& association : associator_->associate(in_world, as_seen_now)) {
    ObjectDecision decision{in_world[association.measurement], association, {}};
    if (const auto found = drifted.find(association.landmark); found != drifted.end())
      decision.seen.covariance.diagonal().head<2>().array() += found->second;
    decision.landmark = landmarks_.update(decision.seen, association);
    associator_->assigned(decision.seen, decision.landmark);
    decision.seen.measurement.detection.mask = cv::Mat();  // large, and not needed any more
    decisions.push_back(std::move(decision));
  }
  if (decisions.empty()) return decisions;
  frames_.add({frame.id, frame.t, frame.camera, frame.robot_from_camera, decisions,
               featuresOnObjects(decisions, features)});
  span(frames_.back());
  return decisions;
}

void ObjectMapper::doubtByScan(std::vector<ObjectMeasurement>& measurements, const Frame& frame,
                               const ObjectDatabase& database) const {
  if (!latest_scan_ || std::abs(frame.t - latest_scan_->t) > kScanAge_s) return;
  const Pose3 world_from_camera = poses_.at(frame.t) * frame.robot_from_camera;
  const Pose3 world_from_scanner = poses_.at(latest_scan_->t);
  for (ObjectMeasurement& measurement : measurements) {
    Proposal& proposal = measurement.proposal;
    const ObjectModel* model = database.find(proposal.model);
    if (!model || model->solid_share <= 0) continue;
    const Pose3 seen = world_from_camera * proposal.camera_from_object;
    const Eigen::Vector3d place = seen.translation();
    const Pose3 upright = poseFromYpr(place.x(), place.y(), place.z(), planarPart(seen).yaw, 0, 0);
    const RayEvidence rays =
        rayEvidence(proposal.shape, upright, *latest_scan_, world_from_scanner, model->solid_share);
    if (rays.through == 0) continue;
    const double stopped = static_cast<double>(rays.inside) / (rays.inside + rays.through);
    proposal.score *= std::max(kLeastDoubted, stopped);
  }
}

void ObjectMapper::missUnseen(const std::vector<ObjectDecision>& decisions,
                              const std::vector<Detection>& detections, const Frame& frame,
                              const std::vector<std::string>& unsought) {
  searched_.push_back({frame.t, unsought});
  std::set<LandmarkId> seen;
  for (const auto& decision : decisions) seen.insert(decision.landmark);
  const Pose3 world_from_camera = poses_.at(frame.t) * frame.robot_from_camera;
  std::vector<LandmarkId> missed;
  for (const auto& landmark : landmarks_.landmarks())
    if (!seen.contains(landmark.id) && !searched_.back().without(landmark.class_name) &&
        shouldBeSeen(landmark, frame, world_from_camera, detections))
      missed.push_back(landmark.id);
  for (const auto id : missed) landmarks_.miss(id, frame.id);
}

void ObjectMapper::continueIds(const std::vector<Landmark>& earlier) {
  const auto same = sameLandmarks(landmarks_.landmarks(), earlier, landmarks_.rules().duplicates);
  for (const auto& [own, id] : same) landmarks_.rename(own, id);
  if (!same.empty()) renameSightings();
}

std::vector<PlaceLook> ObjectMapper::looksAt(const std::vector<Landmark>& landmarks,
                                             const ObjectDatabase& database) const {
  const PosedViews views = space_->posed(poses_);
  std::vector<PlaceLook> out;
  for (const Landmark& landmark : landmarks) {
    std::vector<double> sighted;
    for (const auto& frame : frames_)
      for (const auto& decision : frame.decisions)
        if (decision.landmark == landmark.id) sighted.push_back(frame.t);
    for (const auto& sighting : frames_.former())
      if (sighting.landmark == landmark.id) sighted.push_back(sighting.t);
    std::sort(sighted.begin(), sighted.end());
    std::vector<double> searched;
    for (const auto& image : searched_)
      if (!image.without(landmark.class_name)) searched.push_back(image.t);
    out.push_back(lookAt(landmark, views, searched, sighted, database));
  }
  return out;
}

void ObjectMapper::look(const Frame& frame, const Pose3& world_from_robot, const std::vector<Box2>& people) {
  space_->add(frame, world_from_robot, people);
}

std::vector<Candidate> ObjectMapper::candidates(const ObjectDatabase& database,
                                                const ExistenceModel* model) const {
  const auto landmarks = landmarksNow();
  const auto evidence = existenceEvidence(landmarks, frames_, poses_, space_->posed(poses_), database, searched_);
  std::vector<Candidate> out;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    out.push_back({landmarks[i], evidence[i]});
    if (model) out[i].landmark.existence = model->probability(landmarks[i].shape.kind, evidence[i]);
  }
  return out;
}

void ObjectMapper::observe(const Scan& scan, const Pose3& world_from_robot, const ObjectDatabase& database) {
  space_->add(scan, world_from_robot);
  latest_scan_ = scan;
  if (last_rays_from_) {
    const Pose3 moved = last_rays_from_->inverse() * world_from_robot;
    if (moved.translation().norm() < kRayDistance_m && rotationAngle(moved) < kRayAngle_rad) return;
  }
  last_rays_from_ = world_from_robot;
  for (const Landmark& landmark : std::vector<Landmark>(landmarks_.landmarks())) {
    const ObjectModel* model = database.find(landmark.model);
    const RayEvidence rays = rayEvidence(landmark.shape, landmark.worldFromObject(), scan, world_from_robot,
                                         model ? model->solid_share : 0);
    if (rays.inside > 0) {
      landmarks_.supported(landmark.id, rays.inside);
    } else if (rays.through > 0) {
      landmarks_.seenThrough(landmark.id, rays.through);
    }
  }
}

void ObjectMapper::tidy() {
  const auto split = landmarks_.splitMixed();
  for (const auto& [first, second] : split) shareSightings(first, second);
  const auto merged = landmarks_.mergeDuplicates();
  if (!merged.empty() || !split.empty()) renameSightings();
}

// After merges and splits.
void ObjectMapper::renameSightings() {
  const LandmarkIdentity& identity = landmarks_.identity();
  const auto is_outdated = [&](const ObjectDecision& decision) { return isOutdated(decision, identity); };
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (std::none_of(frames_[i].decisions.begin(), frames_[i].decisions.end(), is_outdated)) continue;  // change() may copy the frame
    for (auto& decision : frames_.change(i).decisions)
      rename(decision, [&identity](LandmarkId id) { return identity.today(id); });
  }
  for (auto& sighting : frames_.changeFormer()) sighting.landmark = identity.today(sighting.landmark);
  associator_->identitiesChanged(identity);
  respan();
}

// A landmark was split: its sightings belong to the nearer one.
void ObjectMapper::shareSightings(LandmarkId first, LandmarkId second) {
  const Eigen::Vector3d first_place = landmarks_.find(first)->position;
  const Eigen::Vector3d second_place = landmarks_.find(second)->position;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    ObjectFrame& frame = frames_.change(i);
    const Pose3 world_from_camera =
        poses_.at(frame.t) * frame.robot_from_camera;  // the poses have changed since
    for (auto& decision : frame.decisions) {
      if (decision.landmark != first) continue;
      const Eigen::Vector3d place =
          (world_from_camera * decision.seen.measurement.proposal.camera_from_object).translation();
      if ((place - second_place).norm() < (place - first_place).norm())
        rename(decision, [first, second](LandmarkId id) { return id == first ? second : id; });
    }
  }
  for (auto& sighting : frames_.changeFormer()) {
    if (sighting.landmark != first) continue;
    const Eigen::Vector3d place = poses_.at(sighting.t) * sighting.place_in_robot;
    if ((place - second_place).norm() < (place - first_place).norm()) sighting.landmark = second;
  }
}

std::vector<std::vector<WorldMeasurement>> ObjectMapper::measurementsInWorld() const {
  std::vector<std::vector<WorldMeasurement>> out;
  for (const auto& frame : frames_) {
    const Pose3 world_from_camera = poses_.at(frame.t) * frame.robot_from_camera;
    out.emplace_back();
    for (const auto& decision : frame.decisions)
      out.back().push_back(
          measurementInWorld(decision.seen.measurement, frame.camera, world_from_camera, pose_sigma_m_));
  }
  return out;
}

Partition ObjectMapper::whoIsWho() const {
  Partition out;
  std::map<LandmarkId, int> labels;
  for (const auto& frame : frames_)
    for (const auto& decision : frame.decisions)
      out.push_back(labels.try_emplace(decision.landmark, static_cast<int>(labels.size())).first->second);
  return out;
}

bool ObjectMapper::reassociate() {
  if (!hindsight_ || frames_.empty()) return false;
  const std::vector<Landmark> optimum = landmarks_.landmarks();
  const auto by_frame = measurementsInWorld();
  const AssociationModel* model = associator_->model();
  const Reassociation result =
      model ? roomgraph::reassociate(by_frame, landmarks_.landmarks(), landmarks_.identity(), *model,
                                     landmarks_.rules())
            : roomgraph::reassociate(by_frame, landmarks_.landmarks(), landmarks_.identity(),
                                     frameByFrame(*associator_, by_frame), {}, landmarks_.rules());
  findHomes(result);
  landmarks_.adopt(by_frame, result, frames_.former());
  std::map<LandmarkId, int> kept;  // more sightings that stayed than came
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    auto& decisions = frames_.change(f).decisions;
    for (std::size_t k = 0; k < by_frame[f].size(); ++k) {
      const BatchDecision& now = result.decisions[f][k];
      kept[now.landmark] += decisions[k].landmark == now.landmark ? 1 : -1;
      decisions[k] = {by_frame[f][k], now.association, now.landmark};
    }
  }
  std::erase_if(kept, [](const auto& entry) { return entry.second <= 0; });
  respan();
  tidy();
  for (const Landmark& landmark : optimum)
    if (kept.contains(landmark.id)) goOnFrom(landmark);
  return true;
}

// The E-step fuses places one sighting after the other: good enough for who is who, but from there a sofa may
// turn to another optimum than the one that the graph had found. What cannot turn begins at the fused place:
// its sightings have changed, and the former one may hold it back.
void ObjectMapper::goOnFrom(const Landmark& optimum) {
  if (optimum.shape.kind != ShapeKind::kCuboid) return;
  if (const Landmark* fused = landmarks_.find(optimum.id); fused && fused->class_name == optimum.class_name)
    landmarks_.correct(optimum.id, optimum.position, optimum.yaw, optimum.shape, fused->covariance);
}

void ObjectMapper::move(const PathShift& shift) {
  for (const auto& [id, span] : spans_)
    if (span.first >= shift.since_t) landmarks_.move(id, shift.new_from_old);
}

namespace {

ObjectsInGraph factorsOf(const std::vector<Landmark>& landmarks, const ObjectFrames& frames,
                         const KeptScans& scans, const AssociationModel* model, const KeyPoses& poses,
                         const ObjectDatabase& database, const BackendOptions& options) {
  ObjectsInGraph out{landmarks, objectFactors(frames, poses, landmarks, database, options,
                                              model ? &model->measurement : nullptr)};
  if (options.object_sides) out.factors.sides = scanSides(scans, poses, landmarks, database, options);
  return out;
}

}  // namespace

ObjectsInGraph ObjectMapper::inGraph(const ObjectDatabase& database, const BackendOptions& options) const {
  return factorsOf(landmarksNow(), frames_, space_->scans(), associator_->model(), poses_, database, options);
}

ObjectsAtPoses ObjectMapper::inGraphLater(const ObjectDatabase& database, const BackendOptions& options) const {
  if (landmarks_.landmarks().empty()) return [](const KeyPoses&) { return ObjectsInGraph{}; };
  struct Copies {
    std::vector<Landmark> landmarks;
    ObjectFrames frames;
    KeptScans scans;
    std::optional<AssociationModel> model;
  };
  auto copies = std::make_shared<Copies>(Copies{landmarksNow(), frames_, space_->scans(), {}});
  if (const AssociationModel* model = associator_->model()) copies->model = *model;
  return [copies, &database, &options](const KeyPoses& poses) {
    return factorsOf(copies->landmarks, copies->frames, copies->scans, copies->model ? &*copies->model : nullptr, poses,
                     database, options);
  };
}

void ObjectMapper::apply(const LandmarkEstimates& estimates) {
  for (const Landmark& landmark : std::vector<Landmark>(landmarks_.landmarks()))
    if (const auto found = estimates.find(landmark.id);
        found != estimates.end() && found->second.shape.kind == landmark.shape.kind)  // else its class has changed since
      landmarks_.correct(landmark.id, found->second.position, found->second.yaw, found->second.shape,
                         landmark.covariance);
}

void ObjectMapper::respan() {
  spans_.clear();
  for (const auto& sighting : frames_.former()) span(sighting.landmark, sighting.t);
  for (const auto& frame : frames_) span(frame);
}

void ObjectMapper::span(const ObjectFrame& frame) {
  for (const auto& decision : frame.decisions) span(decision.landmark, frame.t);
}

void ObjectMapper::span(LandmarkId landmark, double t) {
  SeenSpan& span = spans_.try_emplace(landmark, SeenSpan{t, t}).first->second;
  span.first = std::min(span.first, t), span.last = std::max(span.last, t);
}

}  // namespace roomgraph
