// SPDX-License-Identifier: BSD-3-Clause
// Copies of landmarks, path, shapes and sightings that share what did not change.
#include "view_sink.h"

#include <algorithm>
#include <utility>

namespace roomgraph {
namespace {

constexpr std::size_t kMostScanPoints = 400;

ShownSighting toSighting(double t, const ObjectDecision& decision) {
  const ObjectMeasurement& measurement = decision.seen.measurement;
  return {.landmark = decision.landmark,
          .t = t,
          .made_new = !decision.association.landmark.valid(),
          .probability = decision.association.probability,
          .confidence = measurement.confidence,
          .score = measurement.proposal.score,
          .energy = measurement.energy,
          .posterior = decision.association.posterior,
          .source = measurement.proposal.source};
}

/// What is needed to draw the shapes again later, without anything as large as an image.
std::shared_ptr<const StepReport> withoutPixels(const StepReport& report) {
  auto light = std::make_shared<StepReport>(report);
  light->image = nullptr;
  for (auto& box : light->detections.boxes) box.mask.release();
  for (auto& decision : light->decisions) decision.seen.measurement.detection.mask.release();
  if (light->proposals) {
    light->proposals->traces.clear();
    light->proposals->proposals.clear();
    light->proposals->detections.clear();
  }
  return light;
}

bool sameLandmark(const ShownLandmark& a, const Landmark& b, bool in_map) {
  return a.in_map == in_map && a.landmark.id == b.id && a.landmark.position == b.position &&
         a.landmark.yaw == b.yaw && a.landmark.existence == b.existence &&
         a.landmark.observations == b.observations && a.landmark.covariance == b.covariance &&
         a.landmark.class_name == b.class_name;
}

}  // namespace

ViewSink::ViewSink(const SemanticSlam& slam, StateMailbox& mailbox)
    : slam_(slam), mailbox_(mailbox), grid_(slam.setup().options.mapping) {
  last_.landmarks = std::make_shared<const ShownLandmarks>();
  last_.closures = std::make_shared<const std::vector<ShownClosure>>();
}

void ViewSink::onStep(const StepReport& report) {
  if (report.kind == StepReport::Kind::kOther) return;
  ++last_.record;
  last_.t = report.t;
  last_.world_from_robot = report.world_from_robot;
  last_.planar = slam_.planar();
  last_.note = report.note;
  last_.sightings.clear();
  const auto frame = report.kind == StepReport::Kind::kFrame ? see(report) : nullptr;
  if (report.scan) seeScan(report);
  copyPath();
  copyLandmarks();
  if (grid_.due() && last_.key_poses && !last_.key_poses->empty()) {
    Trajectory poses = slam_.keyPoses().trajectory();
    if (report.t > poses.lastTime()) poses.add(report.t, report.world_from_robot);
    grid_.build(std::move(poses));
  }
  put(frame);
}

std::shared_ptr<const SeenFrame> ViewSink::see(const StepReport& report) {
  last_.frame = withoutPixels(report);
  last_.proposals.clear();
  last_.people.clear();
  for (const auto& decision : report.decisions) last_.sightings.push_back(toSighting(report.t, decision));
  if (!report.image) return nullptr;
  const ObjectDatabase& database = slam_.setup().database;
  const Pose3 world_from_camera = report.world_from_robot * report.image->robot_from_camera;
  if (report.proposals)
    for (const auto& proposal : report.proposals->proposals)
      (database.moves(proposal.class_name) ? last_.people : last_.proposals)
          .push_back({proposal.class_name, proposal.shape, world_from_camera * proposal.camera_from_object});
  if (report.proposals && report.proposals->ground) {
    std::vector<Box2> moving;
    for (const auto& box : report.detections.boxes)
      if (database.moves(box.class_name)) moving.push_back(box.box);
    grid_.add(*report.image, report.proposals->ground->plane, moving);
  }
  auto seen = std::make_shared<SeenFrame>(SeenFrame{report, *report.image});
  seen->report.image = &seen->frame;
  return seen;
}

void ViewSink::seeScan(const StepReport& report) {
  const auto points = report.scan->pointsInRobot();
  const std::size_t step = points.size() / kMostScanPoints + 1;
  last_.scan.clear();
  for (std::size_t i = 0; i < points.size(); i += step)
    last_.scan.push_back((report.world_from_robot * points[i]).cast<float>());
  grid_.add(*report.scan);
}

// Key poses change only when there is a new one; the path is the key poses and the way since the last one.
void ViewSink::copyPath() {
  const auto& nodes = slam_.keyPoses().nodes();
  if (nodes.empty()) return;
  if (!last_.key_poses || last_.key_poses->size() != nodes.size()) {
    auto poses = std::make_shared<ShownPath>();
    for (const auto& node : nodes) poses->push_back(toShown({node.t, node.world_from_robot}));
    last_.key_poses = last_.path = poses;
    if (std::exchange(closures_, slam_.loopClosures().size()) != slam_.loopClosures().size()) {
      auto closures = std::make_shared<std::vector<ShownClosure>>();
      for (const auto& closure : slam_.loopClosures())
        if (!closure.link) closures->push_back({closure.t_a, closure.t_b});
      last_.closures = closures;
    }
  }
}

void ViewSink::copyLandmarks() {
  const LandmarkMap& map = slam_.objects().landmarks();
  ShownLandmarks shown;
  bool changed = map.landmarks().size() != last_.landmarks->size();
  for (std::size_t i = 0; i < map.landmarks().size(); ++i) {
    const Landmark& landmark = map.landmarks()[i];
    const bool in_map = map.isConfirmed(landmark);
    const bool same = i < last_.landmarks->size() && sameLandmark(*(*last_.landmarks)[i], landmark, in_map);
    changed = changed || !same;
    shown.push_back(same ? (*last_.landmarks)[i]
                         : std::make_shared<const ShownLandmark>(ShownLandmark{landmark, in_map, {}}));
  }
  if (changed) last_.landmarks = std::make_shared<const ShownLandmarks>(std::move(shown));
  if (!last_.identity || last_.identity->changes().size() != map.identity().changes().size())
    last_.identity = std::make_shared<const LandmarkIdentity>(map.identity());
}

void ViewSink::onResult(const SlamResult& result) {
  ++last_.record;
  last_.planar = result.map.planar;
  last_.grid = result.map.occupancy;
  auto path = std::make_shared<ShownPath>();
  for (const auto& pose : result.world_from_robot) path->push_back(toShown(pose));
  last_.path = path;
  if (!result.world_from_robot.empty()) last_.world_from_robot = result.world_from_robot.back().pose;
  auto landmarks = std::make_shared<ShownLandmarks>();
  for (const auto& landmark : result.map.landmarks)
    landmarks->push_back(std::make_shared<const ShownLandmark>(ShownLandmark{landmark, true, {}}));
  for (const auto& [landmark, evidence] : result.candidates) {
    std::map<std::string, double> by_name;
    for (std::size_t i = 0; i < evidence.kNames.size(); ++i)
      by_name[std::string(evidence.kNames[i])] = evidence.values()[i];
    const auto known = std::find_if(landmarks->begin(), landmarks->end(),
                                    [&](const auto& other) { return other->landmark.id == landmark.id; });
    const bool in_map = known != landmarks->end();
    auto shown = std::make_shared<const ShownLandmark>(
        ShownLandmark{in_map ? (*known)->landmark : landmark, in_map, std::move(by_name)});
    if (in_map)
      *known = std::move(shown);
    else
      landmarks->push_back(std::move(shown));
  }
  last_.landmarks = landmarks;
  auto sightings = std::make_shared<std::vector<ShownSighting>>();
  for (const auto& frame : slam_.objects().frames())
    for (const auto& decision : frame.decisions) sightings->push_back(toSighting(frame.t, decision));
  last_.all_sightings = sightings;
  last_.note = "the whole recording, with all hindsight";
  last_.key_poses.reset();
  const auto path_with_hindsight = last_.path;
  copyPath();
  last_.path = path_with_hindsight;
  mailbox_.put(std::make_shared<const ViewState>(last_));
}

void ViewSink::put(std::shared_ptr<const SeenFrame> frame) {
  if (auto grid = grid_.newest()) last_.grid = std::move(grid);
  mailbox_.put(std::make_shared<const ViewState>(last_), std::move(frame));
}

}  // namespace roomgraph
