// SPDX-License-Identifier: BSD-3-Clause
// Estimation of robot poses: key poses, sliding window, full optimisation, loop closures.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "roomgraph/core/meter.h"
#include "roomgraph/estimation/closure_gate.h"
#include "roomgraph/estimation/drift.h"
#include "roomgraph/estimation/graph_builder.h"
#include "roomgraph/geometry/ground.h"

namespace roomgraph {

class ResultStore;

/// A rigid transform, in world, of everything first seen at that time or later.
struct PathShift {
  double since_t = 0;
  Pose3 new_from_old = Pose3::Identity();
};

/// Landmarks estimated by an optimisation of the graph.
using LandmarkEstimates = std::map<LandmarkId, LandmarkEstimate>;

/// Landmarks and their factors with key poses as they are given. It may be called from another thread, while the run
/// goes on.
using ObjectsAtPoses = std::function<ObjectsInGraph(const KeyPoses&)>;

class LiveSolve;

/// What an optimisation of the graph found.
struct GraphSolution {
  LandmarkEstimates landmarks;  ///< those that it held
  PathShift later;              ///< of everything first seen after what it held
};

/// The robot's poses in world: key poses, what was measured between them, and the optimisations (method.md
/// sec. 4, M-step). Independent of how objects are stored: it is given their factors and returns their estimates.
class PoseEstimator {
 public:
  /// Both outlive the estimator.
  PoseEstimator(const BackendOptions& options, const Motion& motion);
  ~PoseEstimator();

  /// Solutions of the whole graph are kept there, and recalled. The store outlives the estimator's work.
  void setResultStore(ResultStore& store) { results_ = &store; }

  const KeyPoses& poses() const { return poses_; }
  /// Of the latest key pose.
  const Drift& drift() const { return drift_; }
  /// The graph as optimizeAll() last left it: those solved during the run are not kept.
  const FactorGraph& graph() const { return graph_; }
  /// Whether the robot drives on the floor; else the camera is handheld.
  bool planar() const { return measurements_.planar; }
  /// Whether the floor has been seen by a handheld camera, so that z is up in world.
  bool levelled() const { return levelled_; }
  /// Between robots at two times.
  const GrowingList<RelativePose>& closures() const { return measurements_.closures; }
  /// Closures by images that the drift since cannot have led to.
  int refusedClosures() const { return gate_.refused(); }

  void setPlanar() { measurements_.planar = true; }
  /// Adds a key pose when the robot moved far enough since the last one; returns whether it did.
  bool advance(double t);
  /// A closure over a gap that no source of motion covers also moves the poses after the gap; objects first seen there
  /// are to be moved likewise.
  std::vector<PathShift> addClosures(const std::vector<RelativePose>& offered);
  /// Moves world so that this plane becomes z = 0 and the first key pose keeps x, y and yaw: world stays in
  /// the frame of an earlier map. Of a world that was levelled before, only what came after the last gap that no source of motion covers
  /// is moved likewise: what the floor was seen from before still holds. Returns how; floors measured in what is moved are forgotten.
  PathShift level(const Plane& floor_in_world);
  /// The floor that a handheld camera measured by depth at time t (a plane in the camera's frame), in a
  /// levelled world; seen from a key pose, it becomes a factor. Nothing for a robot on the floor.
  void addFloor(double t, const Plane& in_camera, const Pose3& robot_from_camera);

  /// Whether it is time to optimise everything, not just the latest key poses.
  bool due() const;
  /// Optimises the latest key poses.
  void optimizeWindow();
  /// Begins to optimise everything measured so far, within the time that a run can spare: beside the run where the
  /// program has threads, else in takeOver(). There must be a key pose, and nothing else being optimised.
  void beginLive(ObjectsAtPoses objects);
  /// Whether a solution is on its way, and whether its turn has come: at a key pose that only the number of key poses
  /// decides, so that a run can be repeated.
  bool solving() const { return live_ != nullptr; }
  bool takesOver() const;
  /// Key poses from the beginning of an optimisation of so many to its turn: as many as take a robot, or a replay twice as
  /// fast, longer to drive than it takes.
  static std::size_t lagOf(std::size_t nodes);
  /// Waits for what beginLive() began, and sets the key poses to that; later ones move with the last of them. Nothing
  /// when nothing was begun, the solver found no usable solution, or the poses were moved meanwhile.
  std::optional<GraphSolution> takeOver();
  /// Whether the poses are where all closures that disagreed with them say: none waits for an optimisation.
  bool settled() const { return surprises_.empty() && !again_; }
  /// What the thread of the last solution took, once; nothing when there was none.
  std::optional<Work> takeWork() { return std::exchange(work_, std::nullopt); }
  /// Near the optimum will do where what is sought changes yet, and key poses may move in bodies (`free_nodes`) where these
  /// have their form.
  enum class Effort { kNearInBodies, kNear, kToTheEnd };
  /// Optimises everything, from the former solution if there is one; nothing when the solver found no usable solution.
  std::optional<LandmarkEstimates> optimizeAll(const ObjectsInGraph& objects, Effort effort = Effort::kToTheEnd);
  /// World is the frame of an earlier map, which tells where the robot is.
  void addFix(const MapFix& fix) { measurements_.fixes.push_back(fix); }
  /// Moves the world frame rigidly; there are no fixes yet.
  void transform(const Pose3& new_from_old);

 private:
  void addNode(double t, const Pose3& world_from_robot);
  SolveReport solution(const std::function<SolveReport()>& solve, const std::function<FactorGraph&()>& graph);
  void repeatSurprises();
  std::optional<GraphSolution> accept(const FactorGraph& graph, const SolveReport& report, std::size_t count,
                                      const std::vector<LandmarkId>& landmarks);
  PathShift adopt(const FactorGraph& solved, std::size_t count);
  void slideWindow();
  void restartWindow(std::size_t first);
  void buildWindowAgain();
  void movedFromOutside();
  double surpriseOf(const RelativePose& closure) const;
  void pullSurprises();
  void settleSurprises();
  std::size_t beginningAfterGap() const;
  std::optional<PathShift> reconnect(const RelativePose& closure);
  /// The poses show a closure: they are as sure as it makes them.
  void believe(const RelativePose& closure);

  const BackendOptions& options_;
  const Motion& motion_;
  KeyPoses poses_;
  Drift drift_;
  ClosureGate gate_;
  Measurements measurements_;
  FactorGraph graph_;
  bool graph_is_near_ = false;  ///< optimised to the end, and no poses were moved since: the next solution begins with it
  Window window_;                       ///< of the latest key poses
  std::size_t first_ = 0;               ///< oldest key pose in it
  std::optional<MarginalPrior> prior_;  ///< of them, from measurements since the whole graph was optimised
  ClosuresInPrior in_prior_;
  std::size_t closures_in_window_ = 0;  ///< how many there were when window_ was built
  int nodes_since_optimization_ = 0;
  std::size_t formed_ = 0;  // key poses whose places a solution of the whole graph has set
  bool again_ = false;  ///< what was taken over last did not know of a surprise, or was void
  /// A closure that disagreed with the estimate, and by how much (surpriseOf()) when that was last optimised.
  struct Surprise {
    RelativePose closure;
    double size;
    bool in_graph = false;  ///< in the one that is being optimised
    bool pulled = false;
    bool believed = false;  ///< the drift knows of it
  };
  std::vector<Surprise> surprises_;  ///< while there are any: optimise soon
  bool levelled_ = false;
  ResultStore* results_ = nullptr;
  std::optional<Work> work_;
  std::unique_ptr<LiveSolve> live_;
};

}  // namespace roomgraph
