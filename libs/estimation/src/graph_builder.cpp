// SPDX-License-Identifier: BSD-3-Clause
// Motion edges, anchors, closures and object factors between key poses.
#include "roomgraph/estimation/graph_builder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "local_maps.h"

namespace roomgraph {
namespace {

const NodeId kAnchor{1'000'000'000}, kEarlierMap{1'000'000'001};
constexpr double kFixRobustWidth = 2;  // Cauchy, in standard deviations: things were moved since

// Steps of wheels add up their errors; so do those of images and scans when no local maps are wanted.
void addSteps(FactorGraph& graph, const KeyPose& a, const KeyPose& b, const Motion& motion, bool local_maps) {
  bool covered = false;
  for (const auto* source : {&motion.odometry, &motion.visual, &motion.lidar}) {
    const auto seen = source->between(a.t, b.t, kSourceGap_s);
    covered |= seen.has_value();
    if (seen && (!local_maps || source == &motion.odometry)) graph.add(BetweenFactor{a.id, b.id, seen->a_from_b, seen->covariance, 3.0});
  }
  if (covered) return;
  const Movement unknown = unknownMovement(b.t - a.t);
  graph.add(BetweenFactor{a.id, b.id, unknown.a_from_b, unknown.covariance, 0});
}

// Only measurements of the floor level a handheld camera's world: tilt and height of the first pose are free.
void addLooseAnchor(FactorGraph& graph, const KeyPose& first) {
  Pose3 anchor = toPose3(planarPart(first.world_from_robot));
  graph.addPose(kAnchor, anchor, true);
  Vector6d sigma;
  sigma << 1e-4, 1e-4, 10, 1, 1, 1e-4;
  graph.add(BetweenFactor{kAnchor, first.id, anchor.inverse() * first.world_from_robot,
                          Matrix6d(sigma.cwiseAbs2().asDiagonal()), 0});
}

constexpr double kOnFloorSigma_m = 0.02;
constexpr double kSameYaw_rad = 0.5;

// From the yaw of most sightings derivatives lead to the optimum; so they do from that of a former one,
// unless who is who has changed it.
double startYaw(const Landmark& landmark, double voted, bool optimised) {
  const bool same = landmark.has_yaw && std::abs(wrapAngle(landmark.yaw - voted)) < kSameYaw_rad;
  return optimised && same ? landmark.yaw : voted;
}

// `optimised`: landmarks are where a former graph had them.
void addObjects(FactorGraph& graph, const ObjectsInGraph& in_graph, const BackendOptions& options,
                bool optimised) {
  const ObjectFactors& objects = in_graph.factors;
  for (const auto& landmark : in_graph.landmarks) {
    const auto yaw = objects.yaws.find(landmark.id);
    if (yaw == objects.yaws.end()) continue;
    graph.addLandmark(landmark.id,
                      {landmark.position, startYaw(landmark, yaw->second, optimised), landmark.shape});
    if (options.objects_on_floor) graph.add(LandmarkGroundFactor{landmark.id, kOnFloorSigma_m});
  }
  for (const auto& [id, view] : objects.views) graph.addLandmark(id, view);
  for (const auto& [id, place] : objects.points) graph.addPoint(id, place);
  for (const auto& factor : objects.sightings) graph.add(factor);
  for (const auto& factor : objects.shared_errors) graph.add(factor);
  for (const auto& factor : objects.sizes) graph.add(factor);
  for (const auto& factor : objects.boxes) graph.add(factor);
  for (const auto& factor : objects.point_views) graph.add(factor);
  for (const auto& factor : objects.insides) graph.add(factor);
  for (const auto& factor : objects.sides)
    if (objects.yaws.contains(factor.landmark)) graph.add(factor);
}

// Which key poses of the graph there are, and how they are held.
struct PosesInGraph {
  std::size_t first = 0;      // the oldest
  bool hold = false;          // the gauge is fixed at the first one
  std::size_t free = kAllFree;  // so many latest ones have a pose of their own; older ones move with the first of their body
};

constexpr std::size_t kBody = 10;           // key poses that move together
constexpr std::size_t kShortBodies = 1000;  // latest key poses whose bodies are no longer

// Key poses that move together where one is the latest but age - 1. Twice as many at twice the age: a long run adds few bodies.
std::size_t bodyLength(std::size_t age, std::size_t all, std::size_t free) {
  if (free == kAllFree ? !alwaysInBodies(all) : age <= free) return 1;
  std::size_t length = kBody;
  for (std::size_t oldest = kShortBodies; age > oldest; oldest *= 2) length *= 2;
  return length;
}

void addVariables(FactorGraph& graph, const std::vector<KeyPose>& nodes, const Motion& motion, const PosesInGraph& which,
                  bool fix_first) {
  std::size_t body = which.first;
  for (std::size_t i = which.first; i < nodes.size(); ++i) {
    const std::size_t length = bodyLength(nodes.size() - i, nodes.size() - which.first, which.free);
    if (i == which.first || i % length == 0 || !connected(motion, nodes[i - 1], nodes[i])) {
      body = i;
      graph.addPose(nodes[i].id, nodes[i].world_from_robot, i == which.first && fix_first);
    } else {
      graph.attach(nodes[i].id, nodes[body].id, nodes[i].world_from_robot);
    }
  }
}

// Every key pose stands on the floor. Of a long body one in so many tells so for all of these.
void addFloor(FactorGraph& graph, const std::vector<KeyPose>& nodes, const BackendOptions& options, const PosesInGraph& which) {
  for (std::size_t i = which.hold ? which.first + 1 : which.first; i < nodes.size(); ++i) {
    const std::size_t each = std::max(bodyLength(nodes.size() - i, nodes.size() - which.first, which.free) / kBody, std::size_t{1});
    const double share = 1 / std::sqrt(static_cast<double>(each));
    const auto body = static_cast<std::size_t>(graph.bodyOf(nodes[i].id).value);
    if ((i - body) % each == 0)
      graph.add(PlanarFactor{nodes[i].id, share * options.planar_sigma_z_m, share * options.planar_sigma_tilt_rad});
  }
}

// Key poses, with the factors between neighbours and of the floor.
std::vector<LocalMap> addPoses(FactorGraph& graph, const KeyPoses& poses, const Motion& motion, const Measurements& measurements,
                               const BackendOptions& options, const PosesInGraph& which) {
  const auto& nodes = poses.nodes();
  const auto [first, hold, free] = which;
  const bool loose = hold && first == 0 && !measurements.planar && !measurements.grounds.empty();
  addVariables(graph, nodes, motion, which, hold && !loose);
  if (loose) addLooseAnchor(graph, nodes[first]);
  const bool local_maps = options.local_map_nodes > 0;
  for (std::size_t i = first; i + 1 < nodes.size(); ++i)
    addSteps(graph, nodes[i], nodes[i + 1], motion, local_maps);
  if (measurements.planar) addFloor(graph, nodes, options, which);
  const auto since =
      std::lower_bound(measurements.grounds.begin(), measurements.grounds.end(), nodes[first].id,
                       [](const GroundFactor& ground, NodeId id) { return ground.node < id; });
  for (auto ground = since; ground != measurements.grounds.end(); ++ground) graph.add(*ground);
  if (!local_maps) return {};
  const auto maps = addLocalMaps(graph, poses, motion, first, options);
  // Where a map begins the robot stood on the floor. Scans do not measure tilt and height of theirs: left free, these
  // would give way where yaws disagree.
  if (measurements.planar)
    for (const LocalMap& map : maps)
      if (graph.bodyOf(map.id) == map.id)
        graph.add(PlanarFactor{map.id, options.planar_sigma_z_m, options.planar_sigma_tilt_rad});
  return maps;
}

// Local maps that the prior knows and that later data of their source have replaced: the prior needs their
// poses.
void addReplacedMaps(Window& window, const MarginalPrior& prior) {
  std::set<NodeId> there;
  for (const LocalMap& map : window.local_maps) there.insert(map.id);
  for (std::size_t i = 0; i < prior.variables.nodes.size(); ++i)
    if (const NodeId id = prior.variables.nodes[i]; isLocalMap(id) && !there.contains(id))
      window.graph.addPose(id, prior.poses[i]);
}

}  // namespace

bool alwaysInBodies(std::size_t key_poses) {
  constexpr std::size_t kMostFree = 2000;
  return key_poses > kMostFree;
}

bool connected(const Motion& motion, const KeyPose& a, const KeyPose& b) {
  for (const auto* source : {&motion.odometry, &motion.visual, &motion.lidar})
    if (source->between(a.t, b.t, kSourceGap_s) && !source->pausedWithin(a.t, b.t)) return true;
  return false;
}

std::optional<BetweenFactor> closureFactor(const RelativePose& closure, const KeyPoses& poses, double width) {
  const KeyPose &a = poses.nearest(closure.t_a), &b = poses.nearest(closure.t_b);
  if (a.id == b.id) return std::nullopt;
  BetweenFactor factor{
      a.id, b.id, poses.offset(a, closure.t_a) * closure.a_from_b * poses.offset(b, closure.t_b).inverse(),
      closure.covariance, closure.link ? 0 : width};
  if (closure.planar) {
    for (int i : {2, 3, 4}) {
      factor.covariance.row(i).setZero();
      factor.covariance.col(i).setZero();
      factor.covariance(i, i) = 0.25;
    }
  }
  return factor;
}

namespace {

// The frame of an earlier map is a fixed pose from which the robot is seen.
void addFixes(FactorGraph& graph, const KeyPoses& poses, const std::vector<MapFix>& fixes) {
  graph.addPose(kEarlierMap, Pose3::Identity(), true);
  for (const MapFix& fix : fixes) {
    const KeyPose& node = poses.nearest(fix.t);
    graph.add(BetweenFactor{kEarlierMap, node.id, fix.world_from_robot * poses.offset(node, fix.t).inverse(),
                            fix.covariance, kFixRobustWidth});
  }
}

// Variables of which nothing but the graph has an estimate.
Variables onlyInGraph(const std::vector<LocalMap>& local_maps, const ObjectFactors& objects) {
  Variables out;
  for (const LocalMap& map : local_maps) out.nodes.push_back(map.id);
  for (const auto& [id, view] : objects.views) out.landmarks.push_back(id);
  for (const auto& [id, point] : objects.points) out.points.push_back(id);
  return out;
}

}  // namespace

FactorGraph buildGraph(const KeyPoses& poses, const Motion& motion, const Measurements& measurements,
                       const ObjectsInGraph& objects, const BackendOptions& options,
                       const FactorGraph* former, std::size_t free) {
  FactorGraph graph;
  const bool fixed = !measurements.fixes.empty();
  const auto local_maps = addPoses(graph, poses, motion, measurements, options, {.hold = !fixed, .free = free});
  if (fixed) addFixes(graph, poses, measurements.fixes);
  for (const auto& closure : measurements.closures)
    if (const auto factor = closureFactor(closure, poses, options.closure_robust_width)) graph.addToSum(*factor);
  graph.addSums();
  for (const auto& closure : measurements.pulls)
    if (const auto factor = closureFactor(closure, poses, 0)) graph.add(*factor);
  addObjects(graph, objects, options, former != nullptr);
  if (former) graph.startFrom(*former, onlyInGraph(local_maps, objects.factors));
  return graph;
}

std::vector<LandmarkId> landmarksIn(const FactorGraph& graph, const ObjectsInGraph& objects) {
  std::vector<LandmarkId> out;
  for (const Landmark& landmark : objects.landmarks)
    if (graph.hasLandmark(landmark.id)) out.push_back(landmark.id);
  return out;
}

Window buildWindow(const KeyPoses& poses, const Motion& motion, const Measurements& measurements,
                   const BackendOptions& options, std::size_t first,
                   const std::optional<MarginalPrior>& prior, const ClosuresInPrior& in_prior) {
  Window window;
  window.local_maps = addPoses(window.graph, poses, motion, measurements, options, {.first = first, .hold = !prior});
  if (prior) {
    addReplacedMaps(window, *prior);
    window.graph.add(*prior);
  }
  const KeyPose& oldest = poses.nodes()[first];
  const std::size_t before = first > 0 ? first - 1 : first;
  std::set<NodeId> held;
  // Those that were there before the window say nothing of it: there may be thousands.
  const std::size_t since = before < measurements.closures_before.size() ? measurements.closures_before[before] : 0;
  for (std::size_t i = since; i < measurements.closures.size(); ++i) {
    const RelativePose& closure = measurements.closures[i];
    if (std::max(closure.t_a, closure.t_b) < poses.nodes()[before].t) continue;
    const auto factor = closureFactor(closure, poses, options.closure_robust_width);
    if (!factor || std::max(factor->a, factor->b) < oldest.id) continue;
    const auto left = in_prior.find(std::min(factor->a, factor->b));
    if (left != in_prior.end() && i < left->second) continue;
    for (const NodeId id : {factor->a, factor->b})
      if (id < oldest.id && held.insert(id).second)
        window.graph.addPose(id, poses.node(id).world_from_robot, true);
    window.graph.add(*factor);
  }
  window.held.assign(held.begin(), held.end());
  return window;
}

}  // namespace roomgraph
