// SPDX-License-Identifier: BSD-3-Clause
// Window marginalisation, schedule of full optimisations, and reconnection across gaps.
#include "roomgraph/pipeline/pose_estimator.h"

#include <algorithm>

namespace roomgraph {
namespace {
constexpr int kLiveIterations = 10;  // a run must not stand still for long; the next optimisation goes on
}

PoseEstimator::PoseEstimator(const BackendOptions& options, const Motion& motion)
    : options_(options), motion_(motion), poses_(motion) {
  measurements_.planar = false;
}

bool PoseEstimator::advance(double t) {
  if (poses_.empty()) {
    poses_.add(t, Pose3::Identity());
    return true;
  }
  const KeyPose& last = poses_.nodes().back();
  if (t <= last.t) return false;
  const Pose3 moved = poses_.offset(last, t);
  // A source goes on after a gap that none saw across: where it goes on is unknown, and a pose of its own.
  const KeyPose here{.t = t};
  const bool resumed = connected(motion_, here, here) && !connected(motion_, last, here);
  const bool far = resumed || moved.translation().norm() > options_.node_distance_m ||
                   rotationAngle(moved) > options_.node_angle_rad || t - last.t > options_.node_interval_s;
  if (!far) return false;
  poses_.add(t, last.world_from_robot * moved);
  ++nodes_since_optimization_;
  return true;
}

bool PoseEstimator::surprising(const RelativePose& closure) const {
  const Pose3 expected = poses_.at(closure.t_a).inverse() * poses_.at(closure.t_b);
  const Pose3 difference = closure.a_from_b.inverse() * expected;
  return difference.translation().norm() > options_.urgent_closure_m ||
         rotationAngle(difference) > options_.urgent_closure_rad;
}

// Far from the solution a robust closure pulls too weakly: bring the unconnected part there first.
void PoseEstimator::reconnect(const RelativePose& closure, ObjectMapper& objects) {
  auto& nodes = poses_.nodes();
  const double early = std::min(closure.t_a, closure.t_b), late = std::max(closure.t_a, closure.t_b);
  for (std::size_t i = nodes.size(); i-- > 1;) {
    if (nodes[i].t > late || nodes[i - 1].t < early || connected(motion_, nodes[i - 1], nodes[i])) continue;
    const Pose3 b_now = poses_.at(closure.t_b), a_now = poses_.at(closure.t_a);
    const Pose3 move = closure.t_a < closure.t_b ? a_now * closure.a_from_b * b_now.inverse()
                                                 : b_now * closure.a_from_b.inverse() * a_now.inverse();
    const double since = nodes[i].t;
    for (; i < nodes.size(); ++i) nodes[i].world_from_robot = move * nodes[i].world_from_robot;
    restartWindow();
    objects.moveSince(since, move);
    return;
  }
}

void PoseEstimator::addClosures(const std::vector<RelativePose>& closures, ObjectMapper& objects) {
  for (const auto& closure : closures) {
    if (surprising(closure)) {
      surprised_ = true;
      reconnect(closure, objects);
    }
    measurements_.closures.push_back(closure);
  }
}

// The pause grows with the graph, so that the work per key pose stays bounded on long runs.
bool PoseEstimator::due() const {
  const int nodes = static_cast<int>(poses_.nodes().size());
  const int pause = surprised_ ? std::max(options_.optimize_every_nodes / 4, nodes / 100)
                               : std::max(options_.optimize_every_nodes, nodes / 10);
  return nodes_since_optimization_ >= pause;
}

void PoseEstimator::update(ObjectMapper& objects) {
  if (due()) {
    optimizeAll(objects, {std::min(options_.max_iterations, kLiveIterations), options_.live_tolerance});
  } else {
    optimizeWindow();
  }
}

// The oldest pose leaves the window; what it and the measurements at it say of the others stays as a prior.
void PoseEstimator::slideWindow() {
  const auto& nodes = poses_.nodes();
  if (nodes.size() - first_ <= static_cast<std::size_t>(options_.window_nodes)) return;
  Variables keep{.nodes = window_.held};  // closures to them are added to the next window again
  for (std::size_t i = first_ + 1; i + 1 < nodes.size(); ++i) keep.nodes.push_back(nodes[i].id);
  prior_ = window_.graph.marginalize(keep);
  ++first_;
}

// Poses were moved from elsewhere: they stand, and the window begins anew with the last of them.
void PoseEstimator::restartWindow() {
  first_ = poses_.nodes().size() - 1;
  prior_.reset();
  window_ = buildWindow(poses_, motion_, measurements_, options_, first_, prior_);
}

void PoseEstimator::optimizeWindow() {
  auto& nodes = poses_.nodes();
  slideWindow();
  window_ = buildWindow(poses_, motion_, measurements_, options_, first_, prior_);
  if (!window_.graph.optimize(options_.max_iterations).usable) return;
  for (std::size_t i = first_; i < nodes.size(); ++i)
    nodes[i].world_from_robot = window_.graph.pose(nodes[i].id);
}

bool PoseEstimator::optimizeAll(ObjectMapper& objects) {
  return optimizeAll(objects, SolveOptions{options_.max_iterations});
}

bool PoseEstimator::optimizeAll(ObjectMapper& objects, const SolveOptions& until) {
  if (poses_.empty()) return true;
  nodes_since_optimization_ = 0;
  objects.tidy();
  measurements_.objects = objects.factors();
  LandmarkMap& landmarks = objects.landmarks();
  graph_ = buildGraph(poses_, motion_, measurements_, landmarks.landmarks(), options_);
  const SolveReport report = graph_.optimize(until);
  surprised_ = surprised_ && report.usable && report.iterations >= until.max_iterations;
  if (report.usable)
    for (auto& node : poses_.nodes()) node.world_from_robot = graph_.pose(node.id);
  restartWindow();
  if (!report.usable) return false;
  for (const Landmark& landmark : std::vector<Landmark>(landmarks.landmarks())) {
    if (!graph_.hasLandmark(landmark.id)) continue;
    const LandmarkEstimate estimate = graph_.landmark(landmark.id);
    landmarks.correct(landmark.id, estimate.position, estimate.yaw, landmark.covariance);
  }
  return true;
}

void PoseEstimator::transform(const Pose3& new_from_old) {
  for (auto& node : poses_.nodes()) node.world_from_robot = new_from_old * node.world_from_robot;
  if (!poses_.empty()) restartWindow();
}

}  // namespace roomgraph
