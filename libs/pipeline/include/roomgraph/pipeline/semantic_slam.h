// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/pipeline/graph_builder.h"
#include "roomgraph/pipeline/key_poses.h"
#include "roomgraph/pipeline/motion.h"
#include "roomgraph/pipeline/stages.h"
#include "roomgraph/pipeline/step_report.h"

namespace mrpt::system {
class CTimeLogger;
}

namespace roomgraph {

/// Numbers that a run ends with.
struct RunCounts {
  int frames = 0, scans = 0, odometry = 0, detections = 0;
  int frames_lost = 0, scans_unmatched = 0;
  int key_poses = 0, loop_closures = 0;
  std::map<std::string, int> reasons;  ///< expected failures by reason
};

/// The result of a run.
struct SlamResult {
  std::vector<StampedPose> world_from_robot;   ///< at every frame and scan
  std::vector<StampedPose> world_from_camera;  ///< at every frame (optical)
  CSemanticMap map;
  RunCounts counts;
};

/// Object-level semantic SLAM: wires the stages and owns everything that changes while a run goes on.
class SemanticSlam {
 public:
  explicit SemanticSlam(std::unique_ptr<Stages> stages);
  ~SemanticSlam();

  void addSink(std::shared_ptr<Sink> sink);
  /// One record, in order of time. Records whose time goes backwards are counted and left out.
  void process(const Record& record);
  /// Refines everything with all data and builds the map. May be called at any moment.
  SlamResult finish();

  /// The last graph that was optimised as a whole (after finish(): the final one).
  const FactorGraph& graph() const { return graph_; }
  const Stages& stages() const { return *stages_; }
  /// Milliseconds per stage: name -> (calls, mean, total).
  std::map<std::string, std::array<double, 3>> timings() const;

 private:
  StepReport step(const Frame& frame);
  StepReport step(const Scan& scan);
  StepReport step(const OdometryReading& reading);
  StepReport step(const std::shared_ptr<CObservationDetections>& recorded);

  std::vector<Detection> detect(const Frame& frame, StepReport& report);
  void track(const Frame& frame, const std::vector<Detection>& detections, StepReport& report);
  void seeObjects(const Frame& frame, const std::vector<Detection>& detections, StepReport& report);
  void level(const Frame& frame, const FrameProposals& seen);
  bool advance(double t);
  void closeScanLoops();
  void optimizeWindow();
  void optimizeAll();
  Scan withoutPeople(const Scan& scan, int& removed) const;
  SlamResult collect();

  std::unique_ptr<Stages> stages_;
  std::vector<std::shared_ptr<Sink>> sinks_;
  std::unique_ptr<mrpt::system::CTimeLogger> timer_;

  Motion motion_;                   ///< trajectories of the sources, each in its own frame
  KeyPoses poses_;                  ///< key poses in world
  Measurements measurements_;       ///< what the graph is built from
  FactorGraph graph_;
  RunCounts counts_;
  std::vector<double> robot_times_;                    ///< of all frames and scans
  std::vector<std::pair<double, Pose3>> camera_times_; ///< frame time, robot_from_camera
  std::optional<Frame> last_frame_;                    ///< without its images
  std::optional<double> last_scan_t_;
  std::vector<Box2> people_;                           ///< last seen, px
  FrameProposals last_seen_;                           ///< proposals of the last frame with detections
  Pose3 last_robot_from_camera_ = Pose3::Identity();
  bool levelled_ = false, mounted_ = false;
  int nodes_since_optimization_ = 0;
  std::size_t closures_optimized_ = 0;
};

}  // namespace roomgraph
