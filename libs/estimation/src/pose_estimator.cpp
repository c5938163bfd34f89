// SPDX-License-Identifier: BSD-3-Clause
// Window marginalisation, schedule of full optimisations, levelling, and reconnection across gaps.
#include "roomgraph/estimation/pose_estimator.h"

#include <algorithm>
#include <array>
#include <limits>
#include <opencv2/core/utility.hpp>
#include <stdexcept>

#include "live_solve.h"
#include "local_maps.h"
#include "roomgraph/core/result_store.h"

namespace roomgraph {
namespace {
constexpr int kLiveIterations = 10;  // bounds the work beside a run; the next optimisation begins where this one ended
constexpr int kNearIterations = 10;
constexpr std::size_t kLeastLag = 3, kNodesPerLag = 100;
constexpr std::size_t kLongGraph = 6000;  // key poses: more of them are in few bodies, and take hardly longer to optimise
constexpr double kStillNearing = 0.9;  // of the former disagreement: less is on its way to none
constexpr int kMostWeighings = 20;
constexpr double kSettled_m = 1e-3;

// A source that sees a time but not the movement since the last key pose has begun anew since: what it measures counts from a key pose on.
// Where scans saw the movement that can wait.
bool beginsAnew(const Motion& motion, double last_t, double t) {
  if (motion.lidar.between(last_t, t, kSourceGap_s)) return false;
  const auto begins = [&](const MotionSource* source) { return source->between(t, t, kSourceGap_s) && !source->between(last_t, t, kSourceGap_s); };
  const std::array sources = {&motion.odometry, &motion.visual, &motion.lidar};
  return std::any_of(sources.begin(), sources.end(), begins);
}

// The largest distance of a key pose from where it was.
double movedBetween(const std::vector<KeyPose>& before, const std::vector<KeyPose>& after) {
  double most = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    most = std::max(most, (after[i].world_from_robot.translation() - before[i].world_from_robot.translation()).norm());
  return most;
}
}

PoseEstimator::PoseEstimator(const BackendOptions& options, const Motion& motion)
    : options_(options),
      motion_(motion),
      poses_(motion),
      drift_(motion, options.local_map_nodes > 0) {
  measurements_.planar = false;
}

PoseEstimator::~PoseEstimator() = default;

bool PoseEstimator::advance(double t) {
  if (poses_.empty()) {
    addNode(t, Pose3::Identity());
    return true;
  }
  const KeyPose& last = poses_.nodes().back();
  if (t <= last.t) return false;
  const Pose3 moved = poses_.offset(last, t);
  // After a gap that no source of motion covers, the pose is unknown: it becomes a key pose of its own.
  const KeyPose here{.t = t};
  const bool resumed = connected(motion_, here, here) && !connected(motion_, last, here);
  const bool far = resumed || beginsAnew(motion_, last.t, t) || moved.translation().norm() > options_.node_distance_m ||
                   rotationAngle(moved) > options_.node_angle_rad || t - last.t > options_.node_interval_s;
  if (!far) return false;
  addNode(t, last.world_from_robot * moved);
  ++nodes_since_optimization_;
  return true;
}

void PoseEstimator::addNode(double t, const Pose3& world_from_robot) {
  poses_.add(t, world_from_robot);
  measurements_.closures_before.push_back(measurements_.closures.size());
  drift_.extend(poses_);
}

// How far a closure is from the estimate: 1 where it begins to be urgent.
double PoseEstimator::surpriseOf(const RelativePose& closure) const {
  const Pose3 difference = poses_.differenceFrom(closure);
  return std::max(difference.translation().norm() / options_.urgent_closure_m,
                  rotationAngle(difference) / options_.urgent_closure_rad);
}

// Far from the solution a robust loss makes a closure too weak: one that other views confirm is held without it, once.
void PoseEstimator::pullSurprises() {
  measurements_.pulls.clear();
  for (Surprise& surprise : surprises_)
    if (!std::exchange(surprise.pulled, true) && ClosureGate::needsWitness(surprise.closure)) measurements_.pulls.push_back(surprise.closure);
}

// After an optimisation: those that it brought nearer without satisfying them ask for another one; those that it left
// where they were are outvoted.
void PoseEstimator::settleSurprises() {
  again_ = false;
  std::erase_if(surprises_, [&](Surprise& surprise) {
    const double before = std::exchange(surprise.size, surpriseOf(surprise.closure));
    if (surprise.size <= 1) {
      if (!surprise.believed) believe(surprise.closure);
      return true;
    }
    if (std::exchange(surprise.in_graph, false)) return !(surprise.size < kStillNearing * before);
    again_ = true;  // it came meanwhile, and what was taken over has undone what the window had made of it
    return false;
  });
}

// Far from the solution a robust loss makes a closure too weak: the unconnected part is moved there first.
std::optional<PathShift> PoseEstimator::reconnect(const RelativePose& closure) {
  const auto& nodes = poses_.nodes();
  const double early = std::min(closure.t_a, closure.t_b), late = std::max(closure.t_a, closure.t_b);
  for (std::size_t i = nodes.size(); i-- > 1;) {
    if (nodes[i].t > late || nodes[i - 1].t < early || connected(motion_, nodes[i - 1], nodes[i])) continue;
    const Pose3 b_now = poses_.at(closure.t_b), a_now = poses_.at(closure.t_a);
    const Pose3 move = closure.t_a < closure.t_b ? a_now * closure.a_from_b * b_now.inverse()
                                                 : b_now * closure.a_from_b.inverse() * a_now.inverse();
    poses_.moveFrom(nodes[i].id, move);
    movedFromOutside();
    return PathShift{nodes[i].t, move};
  }
  return std::nullopt;
}

std::vector<PathShift> PoseEstimator::addClosures(const std::vector<RelativePose>& offered) {
  std::vector<PathShift> shifts;
  for (const auto& closure : gate_.admit(offered, poses_, drift_)) {
    // What the poses do not show yet makes them no surer: others that say the same would contradict them.
    bool shown = true;
    if (const double size = surpriseOf(closure); size > 1) {
      const auto shift = reconnect(closure);
      shown = shift.has_value();
      if (shift) shifts.push_back(*shift);
      surprises_.push_back({.closure = closure, .size = size, .believed = shown});
    }
    measurements_.closures.push_back(closure);
    if (shown) believe(closure);
  }
  return shifts;
}

void PoseEstimator::believe(const RelativePose& closure) {
  if (closure.link)
    drift_.link(poses_, closure);
  else
    drift_.close(poses_, closure);
}

// The first key pose after the last gap; 0: all are connected.
std::size_t PoseEstimator::beginningAfterGap() const {
  const auto& nodes = poses_.nodes();
  std::size_t i = nodes.size() - 1;
  const auto linked = [&](const KeyPose& a, const KeyPose& b) {
    return std::any_of(measurements_.closures.begin(), measurements_.closures.end(), [&](const RelativePose& closure) {
      return closure.link && std::min(closure.t_a, closure.t_b) < b.t && std::max(closure.t_a, closure.t_b) > a.t;
    });
  };
  while (i > 0 && (connected(motion_, nodes[i - 1], nodes[i]) || linked(nodes[i - 1], nodes[i]))) --i;
  return i;
}

PathShift PoseEstimator::level(const Plane& floor_in_world) {
  const Pose3 world_from_ground = cameraFromGround(floor_in_world);
  const Pose3 ground_from_world = world_from_ground.inverse();
  const KeyPose first = poses_.nodes()[levelled_ ? beginningAfterGap() : 0];
  const Pose2 kept = planarPart(first.world_from_robot), turned = planarPart(ground_from_world * first.world_from_robot);
  const Pose3 level_from_world = toPose3(kept * turned.inverse()) * ground_from_world;
  std::erase_if(measurements_.grounds, [&](const GroundFactor& ground) { return ground.node >= first.id; });  // of a floor that was none
  const bool all = first.id == poses_.nodes().front().id;
  if (all)  // else world stays where it is
    for (MapFix& fix : measurements_.fixes) fix.world_from_robot = level_from_world * fix.world_from_robot;
  poses_.moveFrom(first.id, level_from_world);
  movedFromOutside();
  levelled_ = true;
  return {all ? -std::numeric_limits<double>::infinity() : first.t, level_from_world};
}

void PoseEstimator::addFloor(double t, const Plane& in_camera, const Pose3& robot_from_camera) {
  if (planar() || !levelled_) return;
  const KeyPose& node = poses_.nodes().back();
  if (node.t != t) return;
  GroundFactor factor{.node = node.id,
                      .normal_in_robot = robot_from_camera.linear() * in_camera.normal,
                      .sigma_normal_rad = options_.ground_sigma_rad,
                      .sigma_offset_m = options_.ground_sigma_m};
  factor.offset_m = in_camera.offset - factor.normal_in_robot.dot(robot_from_camera.translation());
  measurements_.grounds.push_back(factor);
}

// The pause grows with the graph, so that the work per key pose stays bounded on long runs; not for ever, as what came since the
// last optimisation moves in no bodies.
bool PoseEstimator::due() const {
  if (live_ || again_) return !live_;
  const int nodes = static_cast<int>(std::min(poses_.nodes().size(), kLongGraph));
  const int pause = !surprises_.empty() ? std::max(options_.optimize_every_nodes / 2, nodes / 100)
                                          : std::max(options_.optimize_every_nodes, nodes / 20);
  return nodes_since_optimization_ >= pause;
}

// The oldest pose leaves the window; it and its measurements are marginalised to a prior.
void PoseEstimator::slideWindow() {
  const auto& nodes = poses_.nodes();
  if (nodes.size() - first_ <= static_cast<std::size_t>(options_.window_nodes)) return;
  Variables keep{.nodes = window_.held};  // closures to them are added to the next window again, others not
  for (std::size_t i = first_ + 1; i + 1 < nodes.size(); ++i) keep.nodes.push_back(nodes[i].id);
  for (const LocalMap& map : window_.local_maps)
    if (map.end > first_ + 1) keep.nodes.push_back(map.id);
  prior_ = window_.graph.marginalize(keep);
  in_prior_[nodes[first_].id] = closures_in_window_;
  ++first_;
}

// Poses up to `first` are taken as they are, and the window begins again with it.
void PoseEstimator::restartWindow(std::size_t first) {
  first_ = first;
  prior_.reset();
  in_prior_.clear();
  buildWindowAgain();
}

void PoseEstimator::buildWindowAgain() {
  window_ = buildWindow(poses_, motion_, measurements_, options_, first_, prior_, in_prior_);
  closures_in_window_ = measurements_.closures.size();
}

void PoseEstimator::movedFromOutside() {
  graph_is_near_ = false;
  if (live_) live_->outdate();
  restartWindow(poses_.nodes().size() - 1);
}

void PoseEstimator::optimizeWindow() {
  slideWindow();
  buildWindowAgain();
  if (!window_.graph.optimize(options_.max_iterations).usable) return;
  for (std::size_t i = first_; i < poses_.nodes().size(); ++i) {
    const NodeId id = poses_.nodes()[i].id;
    poses_.set(id, window_.graph.pose(id));
  }
}

// Every time afresh: gone on from the former solution, the live pose was worse (docs/results.md).
void PoseEstimator::beginLive(ObjectsAtPoses objects) {
  // A body keeps the form that an optimisation of the whole graph gave it.
  const std::size_t free = std::max(static_cast<std::size_t>(options_.free_nodes), poses_.nodes().size() - formed_);
  nodes_since_optimization_ = 0;
  again_ = graph_is_near_ = false;
  pullSurprises();
  for (Surprise& surprise : surprises_) surprise.in_graph = true;
  live_ = std::make_unique<LiveSolve>(
      poses_, motion_, measurements_, std::move(objects), options_, free,
      SolveOptions{std::min(options_.max_iterations, kLiveIterations), options_.live_tolerance});
  // A result that will be recalled is not computed.
  if (cv::getNumThreads() > 1 && !(results_ && results_->recalling())) live_->goBeside();
}

// What was asked of a solution that is void is asked of the next one, at once.
void PoseEstimator::repeatSurprises() {
  again_ = true;
  for (Surprise& surprise : surprises_)
    if (std::exchange(surprise.in_graph, false)) surprise.pulled = false;
}

bool PoseEstimator::takesOver() const {
  return live_ && poses_.nodes().size() >= live_->nodes() + lagOf(live_->nodes());
}

std::size_t PoseEstimator::lagOf(std::size_t nodes) {
  return std::max(kLeastLag, std::min(nodes, kLongGraph) / kNodesPerLag);
}

std::optional<GraphSolution> PoseEstimator::takeOver() {
  const std::unique_ptr<LiveSolve> live = std::move(live_);
  if (!live) return std::nullopt;
  if (live->outdated()) {
    repeatSurprises();
    return std::nullopt;
  }
  if (results_ && results_->recalling()) live->graph();  // before numbers are read, which bounds the memory that is used
  const SolveReport report =
      solution([&] { return live->solve(); }, [&]() -> FactorGraph& { return live->graph(); });
  work_ = live->workBeside();
  return accept(live->graph(), report, live->nodes(), live->landmarks());
}

// The graph of the first `count` key poses was optimised: poses are where it says. The window goes on from its last one,
// or from the oldest that it may hold.
std::optional<GraphSolution> PoseEstimator::accept(const FactorGraph& graph, const SolveReport& report, std::size_t count,
                                                   const std::vector<LandmarkId>& landmarks) {
  GraphSolution out;
  if (report.usable) {
    out.later = adopt(graph, count);
    formed_ = count;
  }
  settleSurprises();
  const std::size_t size = poses_.nodes().size(), most = static_cast<std::size_t>(options_.window_nodes);
  restartWindow(std::max(count - 1, size - std::min(size, most)));
  if (!report.usable) return std::nullopt;
  for (const LandmarkId id : landmarks) out.landmarks.emplace(id, graph.landmark(id));
  return out;
}

std::optional<LandmarkEstimates> PoseEstimator::optimizeAll(const ObjectsInGraph& objects, Effort effort) {
  SolveOptions until{.max_iterations = options_.max_iterations, .function_tolerance = options_.final_tolerance, .dogleg = true};
  if (effort != Effort::kToTheEnd) {
    until.max_iterations = std::min(options_.max_iterations, kNearIterations);
    until.function_tolerance = options_.live_tolerance;
    pullSurprises();
  } else {
    measurements_.pulls.clear();  // the map is the optimum of what was measured, each once
  }
  if (poses_.empty()) return LandmarkEstimates{};
  live_.reset();
  nodes_since_optimization_ = 0;
  for (Surprise& surprise : surprises_) surprise.in_graph = true;
  const std::size_t free = effort == Effort::kNearInBodies ? static_cast<std::size_t>(options_.free_nodes) : kAllFree;
  // Closures between bodies are weighed by where these are when the graph is built: to the end, until that does not change.
  const bool weigh_again = effort == Effort::kToTheEnd && alwaysInBodies(poses_.nodes().size());
  std::optional<GraphSolution> accepted;
  for (int round = 0; round < (weigh_again ? kMostWeighings : 1); ++round) {
    const std::vector<KeyPose> before = poses_.nodes();
    graph_ = buildGraph(poses_, motion_, measurements_, objects, options_, graph_is_near_ ? &graph_ : nullptr, free);
    const SolveReport report =
        solution([&] { return graph_.optimize(until); }, [&]() -> FactorGraph& { return graph_; });
    graph_is_near_ = report.usable;
    accepted = accept(graph_, report, poses_.nodes().size(), landmarksIn(graph_, objects));
    if (!accepted || movedBetween(before, poses_.nodes()) < kSettled_m) break;
  }
  return accepted ? std::optional(std::move(accepted->landmarks)) : std::nullopt;
}

// The graph is the same when a run is repeated: its solution need not be sought again, only set in `graph`.
SolveReport PoseEstimator::solution(const std::function<SolveReport()>& solve,
                                    const std::function<FactorGraph&()>& graph) {
  const auto encode = [&](const SolveReport& report) {
    std::vector<double> numbers = graph().values();
    numbers.insert(numbers.end(), {report.usable ? 1.0 : 0.0, static_cast<double>(report.iterations)});
    return bytesOfNumbers(numbers);
  };
  const auto decode = [&](const std::string& bytes) {
    std::vector<double> numbers = numbersFrom(bytes);
    if (numbers.size() < 2) throw std::invalid_argument("too short");
    SolveReport report{.usable = numbers.end()[-2] != 0, .iterations = static_cast<int>(numbers.back())};
    numbers.resize(numbers.size() - 2);
    graph().setValues(numbers);
    return report;
  };
  return recalled(results_, "whole graph", poses_.nodes().back().t, solve, encode, decode);
}

// Key poses of the graph are where it says, later ones go with the last of these.
PathShift PoseEstimator::adopt(const FactorGraph& solved, std::size_t count) {
  const auto& nodes = poses_.nodes();
  const KeyPose last = nodes[count - 1];
  const PathShift later{last.t, solved.pose(last.id) * last.world_from_robot.inverse()};
  for (std::size_t i = 0; i < count; ++i) poses_.set(nodes[i].id, solved.pose(nodes[i].id));
  if (count < nodes.size()) poses_.moveFrom(nodes[count].id, later.new_from_old);
  return later;
}

void PoseEstimator::transform(const Pose3& new_from_old) {
  if (poses_.empty()) return;
  poses_.moveFrom(poses_.nodes().front().id, new_from_old);
  movedFromOutside();
}

}  // namespace roomgraph
