// SPDX-License-Identifier: BSD-3-Clause
// FactorGraph as a Ceres problem: parameter blocks, manifolds, loss functions, residual blocks.
#include "roomgraph/backend/factor_graph.h"

#include <ceres/loss_function.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "attached_poses.h"
#include "chordal.h"
#include "costs.h"
#include "graph_state.h"
#include "marginal_prior_cost.h"
#include "solve.h"

namespace roomgraph {
namespace {

ceres::Problem::Options problemOptions() {
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

template <class Map, class Id>
auto& entryOf(Map& map, Id id, const char* what) {
  const auto found = map.find(id);
  if (found == map.end())
    throw std::out_of_range(std::string("factor graph: no ") + what + " " + std::to_string(id.value));
  return found->second;
}

template <class Map, class Id, class Value>
auto& insertInto(Map& map, Id id, const Value& value, const char* what) {
  auto [entry, inserted] = map.try_emplace(id, value);
  if (!inserted)
    throw std::invalid_argument(std::string("factor graph: ") + what + " " + std::to_string(id.value) +
                                " added twice");
  return entry->second;
}

ceres::LossFunction* cauchy(double width) {
  return width > 0 ? new ceres::CauchyLoss(width) : nullptr;
}

ceres::LossFunction* lossOf(const PlanarFactor&) {
  return nullptr;
}
ceres::LossFunction* lossOf(const LandmarkGroundFactor&) {
  return nullptr;
}
ceres::LossFunction* lossOf(const LandmarkSizeFactor&) {
  return nullptr;
}
ceres::LossFunction* lossOf(const MarginalPrior&) {
  return nullptr;
}
ceres::LossFunction* lossOf(const GroundFactor&) {
  return cauchy(1);
}
ceres::LossFunction* lossOf(const BetweenFactor& f) {
  return cauchy(f.robust_width);
}
ceres::LossFunction* lossOf(const CameraPointFactor& f) {
  if (f.loss == RobustLoss::kCauchy || f.robust_width <= 0) return cauchy(f.robust_width);
  return new ceres::HuberLoss(f.robust_width);
}
// The weight scales the robust loss, so that what counts as an outlier does not depend on it.
template <class Weighted>
ceres::LossFunction* lossOf(const Weighted& f) {
  return new ceres::ScaledLoss(cauchy(f.robust_width), f.weight, ceres::TAKE_OWNERSHIP);
}

}  // namespace

FactorGraph::Impl::Impl() : problem(std::make_unique<ceres::Problem>(problemOptions())) {}

FactorGraph::Impl::Pose& FactorGraph::Impl::at(NodeId id) {
  return entryOf(poses, id, "pose");
}
FactorGraph::Impl::Object& FactorGraph::Impl::at(LandmarkId id) {
  return entryOf(objects, id, "landmark");
}
FactorGraph::Impl::Point& FactorGraph::Impl::at(PointId id) {
  return entryOf(points, id, "point");
}

void FactorGraph::Impl::freeYaw(LandmarkId id) {
  auto& object = at(id);
  object.free_yaw = true;
  problem->SetManifold(object.value.data(), nullptr);
}

void FactorGraph::Impl::freeSize(LandmarkId id) {
  auto& object = at(id);
  object.free_size = true;
  problem->SetParameterBlockVariable(object.size.data());
}

namespace {

using Impl = FactorGraph::Impl;
using Blocks = std::vector<double*>;

void append(Blocks& blocks, Impl::Pose& pose) {
  blocks.insert(blocks.end(), {pose.t.data(), pose.q.data()});
}
void append(Blocks& blocks, Impl::Object& object) {
  blocks.insert(blocks.end(), {object.value.data(), object.size.data()});
}
void append(Blocks& blocks, Impl::Point& point) {
  blocks.push_back(point.value.data());
}

template <class... Variables>
Blocks blocksOf(Variables&... variables) {
  Blocks blocks;
  (append(blocks, variables), ...);
  return blocks;
}

// The blocks of each factor, in the order of its cost function.
Blocks blocksOf(Impl& graph, const BetweenFactor& f) {
  if (f.a == f.b)
    throw std::invalid_argument("factor graph: movement from pose " + std::to_string(f.a.value) +
                                " to itself");
  return blocksOf(graph.at(f.a), graph.at(f.b));
}
template <class OfPose>
requires(std::is_same_v<OfPose, PlanarFactor> || std::is_same_v<OfPose, GroundFactor>) Blocks
    blocksOf(Impl& graph, const OfPose& f) {
  return blocksOf(graph.at(f.node));
}
Blocks blocksOf(Impl& graph, const LandmarkFactor& f) {
  Blocks blocks = blocksOf(graph.at(f.node));
  blocks.push_back(graph.at(f.landmark).value.data());
  return blocks;
}
Blocks blocksOf(Impl& graph, const LandmarkViewFactor& f) {
  Blocks blocks{graph.at(f.view).value.data()};
  append(blocks, graph.at(f.landmark));
  return blocks;
}
Blocks blocksOf(Impl& graph, const LandmarkGroundFactor& f) {
  return {graph.at(f.landmark).value.data()};
}
Blocks blocksOf(Impl& graph, const LandmarkSizeFactor& f) {
  return {graph.at(f.landmark).size.data()};
}
Blocks blocksOf(Impl& graph, const LandmarkBoxFactor& f) {
  return blocksOf(graph.at(f.node), graph.at(f.landmark));
}
Blocks blocksOf(Impl& graph, const LandmarkSideFactor& f) {
  return blocksOf(graph.at(f.node), graph.at(f.landmark));
}
Blocks blocksOf(Impl& graph, const CameraPointFactor& f) {
  return blocksOf(graph.at(f.node), graph.at(f.point));
}
Blocks blocksOf(Impl& graph, const PointLandmarkFactor& f) {
  return blocksOf(graph.at(f.point), graph.at(f.landmark));
}
Blocks blocksOf(Impl& graph, const MarginalPrior& f) {
  Blocks blocks;
  for (const NodeId id : f.variables.nodes) append(blocks, graph.at(id));
  for (const LandmarkId id : f.variables.landmarks) append(blocks, graph.at(id));
  for (const PointId id : f.variables.points) append(blocks, graph.at(id));
  return blocks;
}

// Cost function of a factor, with the landmark's shape where it depends on it.
template <class OneFactor>
ceres::CostFunction* costIn(Impl& graph, const OneFactor& f) {
  if constexpr (requires { costOf(f, ShapeKind{}); }) {
    const auto& object = graph.at(f.landmark);
    if (*std::max_element(object.size.begin(), object.size.end()) <= 0)
      throw std::invalid_argument("factor graph: landmark " + std::to_string(f.landmark.value) +
                                  " has no size");
    return costOf(f, object.kind);
  } else {
    return costOf(f);
  }
}

// Makes variable what a factor measures.
template <class OneFactor>
void release(Impl&, const OneFactor&) {}
void release(Impl& graph, const LandmarkFactor& f) {
  if (f.has_yaw) graph.freeYaw(f.landmark);
}
void release(Impl& graph, const LandmarkViewFactor& f) {
  if (!f.has_yaw) return;
  graph.freeYaw(f.view);
  graph.freeYaw(f.landmark);
}
void release(Impl& graph, const LandmarkBoxFactor& f) {
  if (graph.at(f.landmark).kind != ShapeKind::kCylinder) graph.freeYaw(f.landmark);
}
void release(Impl& graph, const LandmarkSideFactor& f) {
  if (graph.at(f.landmark).kind != ShapeKind::kCylinder) graph.freeYaw(f.landmark);
}
void release(Impl& graph, const LandmarkSizeFactor& f) {
  graph.freeSize(f.landmark);
}
void release(Impl& graph, const MarginalPrior& f) {
  auto column = static_cast<Eigen::Index>(kPoseTangent * f.variables.nodes.size());
  for (const LandmarkId id : f.variables.landmarks) {
    if (!f.root.col(column + 3).isZero(0)) graph.freeYaw(id);
    if (!f.root.middleCols<3>(column + 4).isZero(0)) graph.freeSize(id);
    column += kLandmarkTangent;
  }
}

void addTo(Impl& graph, const Factor& factor) {
  std::visit(
      [&graph](const auto& f) {
        const Blocks blocks = blocksOf(graph, f);
        auto* const cost = costIn(graph, f);  // throws for a bad factor: before a loss is allocated
        const auto id = graph.problem->AddResidualBlock(cost, lossOf(f), blocks);
        release(graph, f);
        graph.factors.push_back({f, id});
      },
      factor);
}

}  // namespace

FactorGraph::FactorGraph() : impl_(std::make_unique<Impl>()) {}
FactorGraph::~FactorGraph() = default;
FactorGraph::FactorGraph(FactorGraph&&) noexcept = default;
FactorGraph& FactorGraph::operator=(FactorGraph&&) noexcept = default;

void FactorGraph::addPose(NodeId id, const Pose3& world_from_robot, bool fixed) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(world_from_robot.linear()).normalized();
  const Eigen::Vector3d t = world_from_robot.translation();
  auto& pose = insertInto(impl_->poses, id,
                          Impl::Pose{{t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}, fixed}, "pose");
  impl_->problem->AddParameterBlock(pose.t.data(), 3);
  impl_->problem->AddParameterBlock(pose.q.data(), 4, &impl_->quaternion);
  if (fixed) {
    impl_->problem->SetParameterBlockConstant(pose.t.data());
    impl_->problem->SetParameterBlockConstant(pose.q.data());
  }
}

void FactorGraph::addLandmark(LandmarkId id, const LandmarkEstimate& initial) {
  const auto& p = initial.position;
  const auto& shape = initial.shape;
  auto& object = insertInto(
      impl_->objects, id,
      Impl::Object{{p.x(), p.y(), p.z(), initial.yaw}, {shape.width, shape.depth, shape.height}, shape.kind},
      "landmark");
  impl_->problem->AddParameterBlock(object.value.data(), 4, &impl_->held_yaw);
  impl_->problem->AddParameterBlock(object.size.data(), 3);
  impl_->problem->SetParameterBlockConstant(object.size.data());
}

void FactorGraph::addPoint(PointId id, const Eigen::Vector3d& in_world) {
  auto& point =
      insertInto(impl_->points, id, Impl::Point{{in_world.x(), in_world.y(), in_world.z()}}, "point");
  impl_->problem->AddParameterBlock(point.value.data(), 3);
}

void FactorGraph::add(const Factor& factor) {
  if (impl_->attached.empty())
    addTo(*impl_, factor);
  else if (const auto of_bodies = toldOfBodies(factor, impl_->attached))
    addTo(*impl_, *of_bodies);
}

SolveReport FactorGraph::optimize(int max_iterations) {
  return optimize(SolveOptions{max_iterations});
}

SolveReport FactorGraph::optimize(const SolveOptions& options) {
  return solve(options, solverOptions(options), *impl_->problem);
}

namespace {

// Calls `visit` for every array of numbers in the graph, in the order of the ids.
template <class OfGraph, class Visit>
void visitValues(OfGraph& graph, const Visit& visit) {
  for (auto& [id, pose] : graph.poses) {
    visit(pose.t);
    visit(pose.q);
  }
  for (auto& [id, object] : graph.objects) {
    visit(object.value);
    visit(object.size);
  }
  for (auto& [id, point] : graph.points) visit(point.value);
}

}  // namespace

std::vector<double> FactorGraph::values() const {
  std::vector<double> out;
  visitValues(std::as_const(*impl_),
              [&](const auto& array) { out.insert(out.end(), array.begin(), array.end()); });
  return out;
}

void FactorGraph::setValues(const std::vector<double>& values) {
  std::size_t count = 0;
  visitValues(*impl_, [&](const auto& array) { count += array.size(); });
  if (count != values.size()) throw std::invalid_argument("factor graph: values of another graph");
  auto next = values.begin();
  visitValues(*impl_, [&](auto& array) {
    for (double& value : array) value = *next++;
  });
}

namespace {

template <class Id, class Value>
void takeOver(std::map<Id, Value>& mine, const std::map<Id, Value>& former, const std::vector<Id>& ids) {
  for (const Id id : ids) {
    const auto to = mine.find(id);
    const auto from = former.find(id);
    if (to != mine.end() && from != former.end()) to->second.start(from->second);
  }
}

}  // namespace

void FactorGraph::startFrom(const FactorGraph& former, const Variables& variables) {
  takeOver(impl_->poses, former.impl_->poses, variables.nodes);
  takeOver(impl_->objects, former.impl_->objects, variables.landmarks);
  takeOver(impl_->points, former.impl_->points, variables.points);
}

bool FactorGraph::initializePoses() {
  if (impl_->poses.empty() || !impl_->objects.empty() || !impl_->points.empty()) return false;
  std::vector<RelativeEdge> edges;
  for (const auto& entry : impl_->factors) {
    const auto* f = std::get_if<BetweenFactor>(&entry.factor);
    if (!f) return false;
    const Matrix6d information = f->covariance.inverse();
    edges.push_back({f->a, f->b, f->a_from_b, information.topLeftCorner<3, 3>().trace(),
                     information.bottomRightCorner<3, 3>().trace()});
  }
  std::map<NodeId, Pose3> start;
  std::vector<NodeId> held;
  for (const auto& [id, state] : impl_->poses) {
    start[id] = pose(id);
    if (state.fixed) held.push_back(id);
  }
  if (held.size() > 1) return false;
  const auto set = [&](const std::map<NodeId, Pose3>& poses) {
    for (const auto& [id, value] : poses) {
      auto& state = impl_->poses.at(id);
      if (state.fixed) continue;
      Eigen::Map<Eigen::Vector3d>(state.t.data()) = value.translation();
      Eigen::Map<Eigen::Vector4d>(state.q.data()) = Eigen::Quaterniond(value.linear()).coeffs();
    }
  };
  const NodeId anchor = held.empty() ? start.begin()->first : held.front();
  const auto relaxed = chordalPoses(start, anchor, edges);
  if (!relaxed) return false;
  const double before = chiSquared();
  set(*relaxed);
  if (chiSquared() < before) return true;
  set(start);
  return false;
}

double FactorGraph::chiSquared() const {
  return 2 * costNow(*impl_->problem);
}

LandmarkEstimate FactorGraph::landmark(LandmarkId id) const {
  const auto& object = impl_->at(id);
  const auto& v = object.value;
  return {{v[0], v[1], v[2]}, wrapAngle(v[3]), {object.kind, object.size[0], object.size[1], object.size[2]}};
}

Eigen::Vector3d FactorGraph::point(PointId id) const {
  return Eigen::Vector3d(impl_->at(id).value.data());
}

bool FactorGraph::hasLandmark(LandmarkId id) const {
  return impl_->objects.contains(id);
}
std::size_t FactorGraph::poses() const {
  return impl_->poses.size();
}
std::size_t FactorGraph::landmarks() const {
  return impl_->objects.size();
}
std::size_t FactorGraph::factors() const {
  return impl_->factors.size();
}

}  // namespace roomgraph
