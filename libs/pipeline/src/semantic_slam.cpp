// SPDX-License-Identifier: BSD-3-Clause
// Order of the stages per record, map anchoring, and final refinement.
#include "roomgraph/pipeline/semantic_slam.h"

#include <limits>
#include <set>
#include <stdexcept>

#include "detection_schedule.h"
#include "movement_findings.h"
#include "moving_in_depth.h"
#include "people_in_view.h"
#include "roomgraph/core/heap.h"
#include "roomgraph/observations/mounting.h"
#include "roomgraph/pipeline/clock_settings.h"
#include "roomgraph/pipeline/record_sorter.h"
#include "stage_borders.h"

namespace roomgraph {
namespace {

constexpr double kMovementHorizon_s = 0.15;
constexpr double kLately_s = 60;  // nothing that was seen since is given up as a repetition
constexpr int kMaxClosingRounds = 3, kMaxDescents = 5;

}  // namespace

SemanticSlam::SemanticSlam(std::unique_ptr<Setup> setup)
    : setup_(std::move(setup)),
      front_ends_(setup_->stages, setup_->options),
      detection_schedule_(std::make_unique<DetectionSchedule>(setup_->options.detection, setup_->database)),
      foreseen_detections_(std::make_unique<DetectionClock>(setup_->options.detection)),
      last_foreseen_t_(-std::numeric_limits<double>::infinity()),
      estimator_(setup_->options.backend, front_ends_.motion()),
      objects_(setup_->stages.associator, setup_->options.landmarks, setup_->options.backend.pose_sigma_m,
               estimator_.poses()),
      existence_(setup_->options.existence),
      object_loops_(setup_->options.object_loops),
      mapper_(setup_->options.mapping),
      people_(std::make_unique<PeopleInView>()),
      moving_(std::make_unique<MovingInDepth>()),
      views_(setup_->options.relocalisation),
      last_frame_t_(-std::numeric_limits<double>::infinity()),
      last_scan_t_(last_frame_t_) {}

SemanticSlam::~SemanticSlam() = default;

void SemanticSlam::setResultStore(ResultStore& store) {
  for (Stage* stage : allOf(setup_->stages)) stage->setResultStore(store);
  estimator_.setResultStore(store);
}

void SemanticSlam::process(const Record& record) {
  if (finished_) throw std::logic_error("a run that is finished takes no records");
  if (const std::string problem = problemOfRecord(record); !problem.empty()) {
    ++counts_.reasons["record left out: " + problem];
    return;
  }
  times_.startRecord(timeOf(record));
  if (!first_t_ && !isBoxes(record)) first_t_ = timeOf(record);
  const StepReport report = std::visit([this](const auto& value) { return step(value); }, record);
  requirePose(report.world_from_robot, record);
  for (const auto& sink : sinks_) sink->onStep(report);
}

StepReport SemanticSlam::step(const Frame& frame) {
  if (!inOrder(frame.t, last_frame_t_, "frames")) return {};
  ++counts_.frames;
  if (isMounted(frame)) estimator_.setPlanar();

  FrameDetections detections = detect(frame);                             // sec. 1.1
  const auto people = boxesOfPeople(detections.boxes, setup_->database);  // sec. 5
  std::future<Proposed> proposing = propose(frame, detections.boxes);     // sec. 1.2 to 1.D
  const TrackingResult tracked = track(frame, people);                    // sec. 4, factor 1
  if (map_) map_->add(frame, people, estimator_.poses());                 // sec. 4.9
  localize(frame.t);                                                      // sec. 4, M-step
  views_.add(frame, people, estimator_.poses().at(frame.t));
  FrameProposals proposals = take(proposing);
  watchTilt(frame, proposals.ground);
  std::vector<ObjectDecision> decisions;
  if (proposals.ground) {
    const Plane& floor = proposals.ground->plane;
    if (proposals.ground->from_depth) estimator_.addFloor(frame.t, floor, frame.robot_from_camera);
    const bool placed = isPlaced(frame, tracked);  // nothing is where a pose that is only held says
    if (placed) {
      drawDepth(frame, floor, people, tracked);  // sec. 5
      objects_.look(frame, estimator_.poses().at(frame.t), people);
    }
    if (placed && detections.current() && setup_->options.landmarks.enabled) {
      auto measurements = select(frame, proposals, tracked.features);            // sec. 3
      doubt(measurements, frame);                                                // sec. 5
      decisions = associate(frame, measurements, tracked.features, detections);  // sec. 4, E-step
    }
  }
  // Where nobody looked, or nobody knows where, those seen last are there for a moment still.
  if (detections.current() && proposals.ground) *people_ = peopleInView(proposals, frame.robot_from_camera, setup_->database);

  robot_times_.push_back(frame.t);
  camera_mounts_.emplace_back(frame.t, frame.robot_from_camera);
  return {.kind = StepReport::Kind::kFrame,
          .t = frame.t,
          .world_from_robot = estimator_.poses().at(frame.t),
          .note = tracked.tracked || !setup_->stages.rgbd_odometry ? "" : "not tracked: " + tracked.reason,
          .frame = frame.id,
          .detections = std::move(detections),
          .proposals = std::move(proposals),
          .decisions = std::move(decisions),
          .image = &frame};
}

// Scans that were matched: others may be noise, or of a place that is not where the robot is thought to be.
void SemanticSlam::use(const Scan& clean) {
  mapper_.add(clean);
  objects_.observe(clean, estimator_.poses().at(clean.t), setup_->database);
  if (map_) map_->add(clean, estimator_.poses());
}

StepReport SemanticSlam::step(const Scan& scan) {
  StepReport report{.kind = StepReport::Kind::kScan, .t = scan.t};
  if (!setup_->stages.scan_matcher || !inOrder(scan.t, last_scan_t_, "scans")) return {};
  ++counts_.scans;
  estimator_.setPlanar();

  Scan clean = scan;
  const auto moved = front_ends_.motion().movement(people_->t, scan.t, kMovementHorizon_s);
  counts_.returns_on_people += removePeople(clean, *people_);  // sec. 5
  // Where people were seen stays left out: they walk, too.
  if (moved) counts_.returns_on_people += removePeople(clean, seenAfter(*people_, planarPart(*moved)));
  const ScanMatch matched = match(clean);
  if (!matched.matched) {
    ++counts_.scans_unmatched;
    ++counts_.reasons["lidar: " + matched.reason];
    report.note = "scan not matched: " + matched.reason;
  } else if (setup_->stages.scan_loop_closer) {
    setup_->stages.scan_loop_closer->add(clean, matched);
  }
  clean = withoutBeams(std::move(clean), matched.moving);
  counts_.returns_in_free_space += static_cast<int>(matched.moving.size());
  localize(scan.t);
  if (matched.matched) use(clean);

  robot_times_.push_back(scan.t);
  report.world_from_robot = estimator_.poses().at(scan.t);
  report.scan = std::move(clean);
  return report;
}

StepReport SemanticSlam::step(const OdometryReading& reading) {
  if (!setup_->options.odometry.enabled) return {};
  estimator_.setPlanar();
  ++counts_.odometry;
  if (!front_ends_.add(reading)) {
    ++counts_.reasons["odometry: stamp does not come after the previous one"];
    return {.t = reading.t};
  }
  odometry_times_.push_back(reading.t);
  // Frames and scans say when a pose is wanted; without any for a second, the readings do.
  if (robot_times_.empty() || reading.t > robot_times_.back() + kOdometryAlone_s) localize(reading.t);
  return {.t = reading.t};
}

StepReport SemanticSlam::step(const std::shared_ptr<CObservationDetections>& recorded) {
  ++counts_.detections;
  if (setup_->stages.detector) setup_->stages.detector->feed(*recorded);
  return {};
}

bool SemanticSlam::inOrder(double t, double& last, const std::string& source) {
  if (t <= last) {
    ++counts_.reasons[source + ": stamp does not come after the previous one"];
    return false;
  }
  last = t;
  return true;
}

FrameDetections SemanticSlam::detect(const Frame& frame) {
  const auto& detector = setup_->stages.detector;
  if (!detector || detector->idle()) return {};
  const auto timing = times_.measure("detection");
  if (detection_schedule_->due(frame.t) && detector->due(frame)) {
    const auto found = detector->detect(frame);
    if (found)
      return detection_schedule_->detected(withoutBroken(*found, counts_.reasons), frame, detector->unsought(),
                                           cameraMovement(frame));
    ++counts_.reasons["detection: " + found.reason()];
  }
  return detection_schedule_->missed(frame, cameraMovement(frame));
}

// Since the frame from which boxes are carried, as far as it is known before this frame is tracked.
std::optional<Pose3> SemanticSlam::cameraMovement(const Frame& frame) const {
  const auto since = detection_schedule_->carriedFrom();
  if (!since) return std::nullopt;
  const auto moved = front_ends_.motion().movement(*since, frame.t, kMovementHorizon_s);
  if (!moved) return std::nullopt;
  return frame.robot_from_camera.inverse() * *moved * frame.robot_from_camera;
}

TrackingResult SemanticSlam::track(const Frame& frame, const std::vector<Box2>& people) {
  if (!setup_->stages.rgbd_odometry) return {};
  const auto timing = times_.measure("RGB-D odometry");
  TrackingResult result = front_ends_.track(frame, people);
  if (result.tracked) placed_t_ = frame.t;
  counts_.frames_lost += !result.tracked;
  counts_.frames_with_movers += result.moving > 0;
  if (!result.reason.empty()) ++counts_.reasons["tracking: " + result.reason];
  return result;
}

ScanMatch SemanticSlam::match(const Scan& scan) {
  const auto timing = times_.measure("scan matching");
  return front_ends_.match(scan);
}

std::vector<ObjectMeasurement> SemanticSlam::select(const Frame& frame, const FrameProposals& proposals,
                                                    const std::vector<FeatureTrack>& features) {
  const auto timing = times_.measure("selection");
  const Pose3 world_from_camera = estimator_.poses().at(frame.t) * frame.robot_from_camera;
  auto measurements =
      setup_->stages.proposal_selector->select(proposals, {frame.camera, world_from_camera, features});
  std::erase_if(measurements, [this](const ObjectMeasurement& measurement) {
    if (isBroken("selection", problemOfMeasurement(measurement), counts_.reasons)) return true;
    const auto* model = setup_->database.find(measurement.proposal.class_name);
    return !model || !model->landmark;
  });
  return measurements;
}

void SemanticSlam::doubt(std::vector<ObjectMeasurement>& measurements, const Frame& frame) const {
  if (setup_->options.landmarks.doubt_by_scan) objects_.doubtByScan(measurements, frame, setup_->database);
}

std::vector<ObjectDecision> SemanticSlam::associate(const Frame& frame,
                                                    const std::vector<ObjectMeasurement>& measurements,
                                                    const std::vector<FeatureTrack>& features,
                                                    const FrameDetections& detections) {
  const auto timing = times_.measure("association");
  auto decisions = objects_.associate(measurements, frame, features, estimator_.drift());
  if (detections.fresh) objects_.missUnseen(decisions, detections.boxes, frame, detections.unsought);
  return decisions;
}

void SemanticSlam::localize(double t) {
  if (!estimator_.advance(t)) return;
  addClosures(front_ends_.takeImageClosures());
  {
    const auto timing = times_.measure("scan loop closing");
    closeLoopsOfScans();
  }
  {
    const auto timing = times_.measure("object loop closing");
    const auto verify = [this](const RelativePose& proposed) { return front_ends_.verify(proposed); };
    if (const auto closure = object_loops_.search(objects_, estimator_.poses(), verify)) addClosures({*closure});
  }
  if (estimator_.takesOver()) takeOver();
  if (estimator_.due()) {
    const auto timing = times_.measure("whole graph");
    objects_.tidy();
    estimator_.beginLive(objects_.inGraphLater(setup_->database, setup_->options.backend));
  }
  {
    const auto timing = times_.measure("window of poses");
    estimator_.optimizeWindow();
  }
  anchor();
}

// What was found beside the run.
void SemanticSlam::takeOver() {
  {
    const auto timing = times_.measure("whole graph");
    if (const auto solution = estimator_.takeOver()) {
      objects_.move(solution->later);
      objects_.apply(sound(solution->landmarks));
      if (estimator_.settled()) {
        objects_.followMoved(estimator_.drift(), followed_t_);
        followed_t_ = estimator_.poses().nodes().back().t;
      }
      giveUpRepeated();
    }
    giveBackFreedMemory();
  }
  if (const auto work = estimator_.takeWork()) times_.add("whole graph beside the run", *work);
}

// So that memory grows with the area seen.
void SemanticSlam::giveUpRepeated() {
  const auto kept = static_cast<std::size_t>(setup_->options.backend.views_kept);
  const auto& nodes = estimator_.poses().nodes();
  Trajectory until_lately;
  for (const KeyPose& node : nodes)
    if (node.t < nodes.back().t - kLately_s) until_lately.add(node.t, node.world_from_robot);
  objects_.giveUpRepeated(kept, until_lately);
  views_.giveUpRepeated(kept, until_lately);
  mapper_.giveUpRepeated(kept, until_lately);
}

// Returns whether there were new ones.
bool SemanticSlam::closeLoopsOfScans() {
  const auto& closer = setup_->stages.scan_loop_closer;
  if (!closer || estimator_.poses().empty()) return false;
  const auto closures = closer->search([&](double t) { return estimator_.poses().between(t); });
  addClosures(closures);
  return !closures.empty();
}

void SemanticSlam::addClosures(const std::vector<RelativePose>& closures) {
  for (const PathShift& shift : estimator_.addClosures(withoutBroken(closures, counts_.reasons))) objects_.move(shift);
}

ObjectsInGraph SemanticSlam::inGraph() const {
  return objects_.inGraph(setup_->database, setup_->options.backend);
}

// With all data, to the end.
void SemanticSlam::optimizeAll(PoseEstimator::Effort effort) {
  objects_.tidy();
  if (effort != PoseEstimator::Effort::kNearInBodies) giveBackFreedMemory();  // without bodies it needs most of a run
  if (const auto landmarks = estimator_.optimizeAll(inGraph(), effort))
    objects_.apply(sound(*landmarks));
  else
    ++counts_.reasons["back end: no usable solution"];
}

void SemanticSlam::setMap(CSemanticMap map) {
  for (const Landmark& landmark : map.landmarks) objects_.reserveIds(landmark.id);
  map_.emplace(std::move(map), setup_->options.relocalisation, setup_->options.object_loops.constellation);
}

// Looks for the run's place in the map given to it, and moves the world there when it is known; from then on
// ties it to the map. Returns whether it did one of these.
bool SemanticSlam::anchor() {
  if (!map_ || estimator_.poses().empty()) return false;
  const auto timing = times_.measure("earlier map");
  const auto fix = map_->fix(estimator_.poses());
  if (fix) estimator_.addFix(*fix);
  const auto map_from_world =
      map_->recognise(objects_.landmarks().confirmed(), estimator_.poses(), estimator_.planar());
  if (!map_from_world) return fix.has_value();
  estimator_.transform(*map_from_world);
  floors_.clear();
  objects_.move({-std::numeric_limits<double>::infinity(), *map_from_world});
  return true;
}

// Landmarks of the map that were seen again take over their ids.
void SemanticSlam::continueInMap() {
  if (map_ && map_->anchoring()) objects_.continueIds(map_->map().landmarks);
}

std::vector<Finding> SemanticSlam::movementFindings() const {
  auto findings = roomgraph::movementFindings(front_ends_.agreement());
  for (const ClockSetting& clock : wrongClocks(front_ends_)) findings.push_back(clockFinding(clock, false));
  return findings;
}

SlamResult SemanticSlam::finish() {
  finished_ = true;
  refine();
  return collect();
}

// With all data: poses, landmarks, and who is who. Whatever changes something is followed by an optimisation.
void SemanticSlam::refine() {
  const auto timing = times_.measure("hindsight");
  if (estimator_.solving()) takeOver();
  addClosures(front_ends_.takeImageClosures());  // found since the last key pose
  front_ends_.refine();
  front_ends_.releaseImages();
  optimizeAll(PoseEstimator::Effort::kNear);  // what the front ends have refined gives bodies another form
  const auto near = [this] { optimizeAll(PoseEstimator::Effort::kNearInBodies); };
  // Loops close after poses moved, until nothing new is found.
  for (int round = 0; round < kMaxClosingRounds && closeLoopsOfScans(); ++round) near();
  if (anchor()) near();
  front_ends_.releaseScans();
  // Coordinate descent (sec. 4): who is who with the poses as they are, poses and places with who is who, until that
  // comes again: single sightings between two objects go to and fro.
  objects_.followMoved(estimator_.drift(), -std::numeric_limits<double>::infinity());
  std::set<Partition> known{objects_.whoIsWho()};
  for (int round = 0; round < kMaxDescents && objects_.reassociate(); ++round) {
    if (!known.insert(objects_.whoIsWho()).second) break;
    near();
  }
  continueInMap();
  // The map is the optimum of who is who in the end.
  optimizeAll(PoseEstimator::Effort::kToTheEnd);
}

}  // namespace roomgraph
