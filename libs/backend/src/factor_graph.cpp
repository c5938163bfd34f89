// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/backend/factor_graph.h"

#include <glog/logging.h>

#include <algorithm>
#include <stdexcept>

#include "graph_state.h"
#include "residuals.h"

namespace roomgraph {
namespace {

template <class Residual, int Count, int... Blocks, class Factor>
ceres::CostFunction* costOf(const Factor& factor) {
  return new ceres::AutoDiffCostFunction<Residual, Count, Blocks...>(new Residual(factor));
}

ceres::LossFunction* lossOf(double width) {
  return width > 0 ? new ceres::CauchyLoss(width) : nullptr;
}

// Weight outside the robust loss: what counts as an outlier does not depend on how much a measurement counts.
ceres::LossFunction* weighted(ceres::LossFunction* loss, double weight) {
  return new ceres::ScaledLoss(loss, weight, ceres::TAKE_OWNERSHIP);
}

// Ceres reports a singular problem on stderr before it says so in its result.
class QuietCeres {
 public:
  QuietCeres() { FLAGS_minloglevel = google::GLOG_FATAL; }
  ~QuietCeres() { FLAGS_minloglevel = level_; }
  QuietCeres(const QuietCeres&) = delete;
  QuietCeres& operator=(const QuietCeres&) = delete;

 private:
  int level_ = FLAGS_minloglevel;
};

ceres::Problem::Options problemOptions() {
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

}  // namespace

FactorGraph::Impl::Impl() : problem(std::make_unique<ceres::Problem>(problemOptions())) {}

FactorGraph::Impl::Pose& FactorGraph::Impl::at(NodeId id) {
  const auto found = poses.find(id);
  if (found == poses.end()) throw std::out_of_range("factor graph: no pose " + std::to_string(id.value));
  return found->second;
}

FactorGraph::Impl::Object& FactorGraph::Impl::at(LandmarkId id) {
  const auto found = objects.find(id);
  if (found == objects.end())
    throw std::out_of_range("factor graph: no landmark " + std::to_string(id.value));
  return found->second;
}

FactorGraph::FactorGraph() : impl_(std::make_unique<Impl>()) {}
FactorGraph::~FactorGraph() = default;
FactorGraph::FactorGraph(FactorGraph&&) noexcept = default;
FactorGraph& FactorGraph::operator=(FactorGraph&&) noexcept = default;

void FactorGraph::addPose(NodeId id, const Pose3& world_from_robot, bool fixed) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(world_from_robot.linear()).normalized();
  const Eigen::Vector3d t = world_from_robot.translation();
  auto [entry, inserted] =
      impl_->poses.try_emplace(id, Impl::Pose{{t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}, fixed});
  if (!inserted)
    throw std::invalid_argument("factor graph: pose " + std::to_string(id.value) + " added twice");
  auto& pose = entry->second;
  impl_->problem->AddParameterBlock(pose.t.data(), 3);
  impl_->problem->AddParameterBlock(pose.q.data(), 4, impl_->quaternion.get());
  if (fixed) {
    impl_->problem->SetParameterBlockConstant(pose.t.data());
    impl_->problem->SetParameterBlockConstant(pose.q.data());
  }
}

void FactorGraph::addLandmark(LandmarkId id, const LandmarkEstimate& initial) {
  const auto& p = initial.position;
  auto [entry, inserted] =
      impl_->objects.try_emplace(id, Impl::Object{{p.x(), p.y(), p.z(), initial.yaw}, false});
  if (!inserted)
    throw std::invalid_argument("factor graph: landmark " + std::to_string(id.value) + " added twice");
  impl_->problem->AddParameterBlock(entry->second.value.data(), 4);
}

void FactorGraph::add(const BetweenFactor& factor) {
  auto &a = impl_->at(factor.a), &b = impl_->at(factor.b);
  impl_->problem->AddResidualBlock(costOf<BetweenResidual, 6, 3, 4, 3, 4>(factor),
                                   lossOf(factor.robust_width), a.t.data(), a.q.data(), b.t.data(),
                                   b.q.data());
  impl_->between.push_back(factor);
}

void FactorGraph::add(const PlanarFactor& factor) {
  auto& pose = impl_->at(factor.node);
  impl_->problem->AddResidualBlock(costOf<PlanarResidual, 3, 3, 4>(factor), nullptr, pose.t.data(),
                                   pose.q.data());
}

void FactorGraph::add(const GroundFactor& factor) {
  auto& pose = impl_->at(factor.node);
  impl_->problem->AddResidualBlock(costOf<GroundResidual, 3, 3, 4>(factor), lossOf(1), pose.t.data(),
                                   pose.q.data());
}

void FactorGraph::add(const LandmarkFactor& factor) {
  auto& pose = impl_->at(factor.node);
  auto& object = impl_->at(factor.landmark);
  impl_->problem->AddResidualBlock(costOf<LandmarkResidual, 4, 3, 4, 4>(factor),
                                   weighted(lossOf(factor.robust_width), factor.weight), pose.t.data(),
                                   pose.q.data(), object.value.data());
  object.seen_yaw |= factor.has_yaw;
  impl_->sightings.push_back(factor);
}

void FactorGraph::add(const LandmarkGroundFactor& factor) {
  auto& object = impl_->at(factor.landmark);
  impl_->problem->AddResidualBlock(costOf<LandmarkGroundResidual, 1, 4>(factor), nullptr,
                                   object.value.data());
}

SolveReport FactorGraph::optimize(int max_iterations) {
  // A yaw that nothing measures would make the normal equations singular: hold it.
  std::vector<std::unique_ptr<ceres::SubsetManifold>> held;
  for (auto& [id, object] : impl_->objects) {
    if (object.seen_yaw) continue;
    held.push_back(std::make_unique<ceres::SubsetManifold>(4, std::vector<int>{3}));
    impl_->problem->SetManifold(object.value.data(), held.back().get());
  }
  ceres::Solver::Options options;
  options.max_num_iterations = max_iterations;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.num_threads = 1;  // sums in one order: the same bits on every machine
  options.function_tolerance = 1e-8;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  const QuietCeres quiet;
  ceres::Solve(options, impl_->problem.get(), &summary);
  for (auto& [id, object] : impl_->objects) impl_->problem->SetManifold(object.value.data(), nullptr);
  return {summary.IsSolutionUsable(), summary.initial_cost, summary.final_cost,
          static_cast<int>(summary.iterations.size()), summary.message};
}

Pose3 FactorGraph::pose(NodeId id) const {
  const auto& state = impl_->poses.at(id);
  Pose3 pose = Pose3::Identity();
  pose.linear() = Eigen::Quaterniond(state.q.data()).normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(state.t[0], state.t[1], state.t[2]);
  return pose;
}

LandmarkEstimate FactorGraph::landmark(LandmarkId id) const {
  const auto& value = impl_->objects.at(id).value;
  return {{value[0], value[1], value[2]}, wrapAngle(value[3])};
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
  return static_cast<std::size_t>(impl_->problem->NumResidualBlocks());
}

std::optional<std::map<LandmarkId, Eigen::Matrix4d>> FactorGraph::landmarkCovariances() const {
  const QuietCeres quiet;
  std::vector<const double*> blocks;
  std::vector<std::unique_ptr<ceres::SubsetManifold>> held;
  for (auto& [id, object] : impl_->objects) {
    blocks.push_back(object.value.data());
    if (object.seen_yaw) continue;
    held.push_back(std::make_unique<ceres::SubsetManifold>(4, std::vector<int>{3}));
    impl_->problem->SetManifold(object.value.data(), held.back().get());
  }
  ceres::Covariance::Options options;
  options.num_threads = 1;
  ceres::Covariance covariance(options);
  std::vector<std::pair<const double*, const double*>> pairs;
  for (const auto* block : blocks) pairs.emplace_back(block, block);
  const bool computed = !blocks.empty() && covariance.Compute(pairs, impl_->problem.get());
  std::map<LandmarkId, Eigen::Matrix4d> result;
  for (auto& [id, object] : impl_->objects) {
    Eigen::Matrix<double, 4, 4, Eigen::RowMajor> block;
    if (computed) covariance.GetCovarianceBlock(object.value.data(), object.value.data(), block.data());
    if (!object.seen_yaw) block(3, 3) = M_PI * M_PI / 3;  // uniform over the circle
    result[id] = block;
    impl_->problem->SetManifold(object.value.data(), nullptr);
  }
  if (!computed) return std::nullopt;
  return result;
}

}  // namespace roomgraph
