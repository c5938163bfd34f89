// SPDX-License-Identifier: BSD-3-Clause
// SemanticSlam: the complete system, record by record, and the result of a run.
#pragma once

#include <future>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "roomgraph/datasets/rawlog_report.h"
#include "roomgraph/datasets/record_stream.h"
#include "roomgraph/estimation/camera_tilt.h"
#include "roomgraph/estimation/floor_consensus.h"
#include "roomgraph/estimation/map_anchor.h"
#include "roomgraph/estimation/object_loop_closer.h"
#include "roomgraph/estimation/object_mapper.h"
#include "roomgraph/estimation/pose_estimator.h"
#include "roomgraph/estimation/view_memory.h"
#include "roomgraph/mapping/occupancy_mapper.h"
#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/pipeline/front_ends.h"
#include "roomgraph/pipeline/setup.h"
#include "roomgraph/pipeline/stage_times.h"
#include "roomgraph/pipeline/step_report.h"

namespace roomgraph {

/// Numbers that a run ends with.
struct RunCounts {
  int frames = 0, scans = 0, odometry = 0, detections = 0;
  int frames_lost = 0, scans_unmatched = 0;
  int returns_on_people = 0;      ///< left out, as images show somebody there
  int frames_with_movers = 0;  ///< in which features moved together, and not with the rest
  int returns_in_free_space = 0;  ///< of scans, or of depth images for the grid: left out, as those before show that nothing was there
  int key_poses = 0, loop_closures = 0;
  int links = 0;                  ///< between segments of tracking: movements, which close no loop
  std::map<std::string, int> reasons;  ///< expected failures by reason
};

/// What came of the earlier map that a run was given.
struct EarlierMap {
  bool recognised = false;  ///< the results are in its frame, and the map continues it
  int common = 0;           ///< objects in it that were seen again
  double after_s = 0;       ///< from the first record of the run
  std::string by;           ///< "scans and images"
  std::string missing;      ///< what the earlier map does not hold for re-localisation, in words
  int appeared = 0, vanished = 0, unseen = 0;  ///< objects that are new, gone, and not looked at
};

/// The result of a run.
struct SlamResult {
  std::vector<StampedPose>
      world_from_robot;  ///< at every frame and scan (with neither: at every odometry reading)
  std::vector<StampedPose> world_from_camera;  ///< at every frame (optical)
  CSemanticMap map;
  std::vector<Candidate> candidates;  ///< every landmark, in the map or not
  SeenSpans seen;  ///< landmarks of this recording; those that only the earlier map holds are not in it
  RunCounts counts;
  std::optional<EarlierMap> earlier;  ///< nothing: the run was given none
};

class DetectionClock;
class DetectionSchedule;
class MovingInDepth;
class ResultStore;
struct PeopleInView;

/// Object-level semantic SLAM: wires the stages and owns everything that changes while a run goes on.
class SemanticSlam {
 public:
  explicit SemanticSlam(std::unique_ptr<Setup> setup);
  ~SemanticSlam();

  /// What takes long is kept there, and recalled when the run is repeated with the same store
  /// (core/result_store.h). To be called before the first record; the store outlives this.
  void setResultStore(ResultStore& store);
  void addSink(std::shared_ptr<Sink> sink) { sinks_.push_back(std::move(sink)); }
  /// The run is to continue this map; until its place in it is known the run is in its own frame.
  void setMap(CSemanticMap map);
  /// A record that will come: what is known of it before its turn is computed now and kept. For all records in their order, on
  /// any one thread beside process(), or for none; the result is the same.
  void foresee(const Record& record);
  /// One record, in order of time. Records whose time goes backwards are counted and left out. Throws std::logic_error after
  /// finish().
  void process(const Record& record);
  /// Refines everything with all data and builds the map. After any record, once: what the stages remembered is given up.
  SlamResult finish();

  /// Of finish(): the final one; empty before.
  const FactorGraph& graph() const { return estimator_.graph(); }
  /// Every measured object and the landmark it belongs to; after finish() with all hindsight.
  const ObjectMapper& objects() const { return objects_; }
  /// The poses of the graph.
  const KeyPoses& keyPoses() const { return estimator_.poses(); }
  const GrowingList<RelativePose>& loopClosures() const { return estimator_.closures(); }
  /// Whether the robot drives on the floor; else the camera is handheld.
  bool planar() const { return estimator_.planar(); }
  const Setup& setup() const { return *setup_; }
  /// Adds work on the record being processed that was done elsewhere to the times.
  void account(const char* stage, const Work& work) { times_.add(stage, work); }
  /// The sensors, with what wheels were found to err by.
  const FrontEnds& frontEnds() const { return front_ends_; }
  /// Where a camera on the robot sees the floor.
  const CameraTilt& cameraTilt() const { return tilt_; }
  /// What the movements that the sensors measured say against each other.
  std::vector<Finding> movementFindings() const;
  /// Of every call of every stage.
  const StageTimes& times() const { return times_; }

 private:
  StepReport step(const Frame& frame);
  StepReport step(const Scan& scan);
  StepReport step(const OdometryReading& reading);
  StepReport step(const std::shared_ptr<CObservationDetections>& recorded);

  void foreseeDetections(const Frame& frame);
  FrameDetections detect(const Frame& frame);
  TrackingResult track(const Frame& frame, const std::vector<Box2>& people);
  FrameGround seeGround(const Frame& frame);
  void drawDepth(const Frame& frame, const Plane& floor, const std::vector<Box2>& people, const TrackingResult& tracked);
  void watchTilt(const Frame& frame, const std::optional<GroundEstimate>& where_expected);
  bool findFloor(const Frame& frame, const Plane& in_camera);
  struct Proposed {
    FrameProposals proposals;
    Work work;
  };
  std::future<Proposed> propose(const Frame& frame, const std::vector<Detection>& detections);
  FrameProposals take(std::future<Proposed>& proposing);
  std::vector<ObjectMeasurement> select(const Frame& frame, const FrameProposals& proposals,
                                        const std::vector<FeatureTrack>& features);
  void doubt(std::vector<ObjectMeasurement>& measurements, const Frame& frame) const;
  std::vector<ObjectDecision> associate(const Frame& frame, const std::vector<ObjectMeasurement>& measurements,
                                        const std::vector<FeatureTrack>& features,
                                        const FrameDetections& detections);
  ScanMatch match(const Scan& scan);
  void use(const Scan& clean);
  /// Whether wheels or scans tell where the robot is then.
  bool placedByOthers(double t) const;
  /// Whether the frame's own sensor or another one tells where it was taken.
  bool isPlaced(const Frame& frame, const TrackingResult& tracked) const;

  void localize(double t);
  void takeOver();
  void giveUpRepeated();
  bool closeLoopsOfScans();
  void addClosures(const std::vector<RelativePose>& closures);
  ObjectsInGraph inGraph() const;
  void optimizeAll(PoseEstimator::Effort effort);
  bool anchor();
  void continueInMap();
  void mapOccupancy(SlamResult& result, const Trajectory& dense);
  std::vector<double> timesOfPoses() const;
  void refine();
  SlamResult collect();

  bool inOrder(double t, double& last, const std::string& source);
  std::optional<Pose3> cameraMovement(const Frame& frame) const;

  std::unique_ptr<Setup> setup_;
  std::vector<std::shared_ptr<Sink>> sinks_;
  StageTimes times_;

  FrontEnds front_ends_;     ///< trajectories of the sources
  std::unique_ptr<DetectionSchedule> detection_schedule_;  ///< when the detector runs; boxes of frames between
  std::unique_ptr<DetectionClock> foreseen_detections_;  ///< of foresee(); nothing else uses it
  double last_foreseen_t_;
  PoseEstimator estimator_;  ///< key poses, measurements between them, the factor graph
  double followed_t_ = 0;    ///< landmarks sighted before were asked whether they were moved
  FloorConsensus floors_;    ///< planes that may be the floor of a handheld camera
  CameraTilt tilt_;          ///< of a camera on a robot
  ObjectMapper objects_;     ///< what was seen of objects
  ExistenceModel existence_;
  ObjectLoopCloser object_loops_;
  OccupancyMapper mapper_;                ///< scans and depth images, for the grid
  std::unique_ptr<PeopleInView> people_;  ///< in the last frame, for the scans after it
  std::unique_ptr<MovingInDepth> moving_;  ///< before the camera, where the grid is of depth images
  std::optional<MapAnchor> map_;          ///< an earlier map that is continued
  ViewMemory views_;                      ///< for whoever continues this one
  RunCounts counts_;
  static constexpr double kOdometryAlone_s = 1;  // without frames and scans
  double last_frame_t_, last_scan_t_;
  double placed_t_ = -1e300;  ///< of the last frame that was tracked
  std::optional<double> first_t_;                        ///< of the first record
  bool finished_ = false;
  std::vector<double> robot_times_, odometry_times_;     ///< of all frames and scans; of all readings
  std::vector<std::pair<double, Pose3>> camera_mounts_;  ///< frame time, robot_from_camera
};

}  // namespace roomgraph
