// SPDX-License-Identifier: BSD-3-Clause
// Change of frame of every kind of factor, from a pose to the one that it moves with.
#include "attached_poses.h"

#include <stdexcept>

#include "graph_state.h"
#include "roomgraph/geometry/covariance.h"
#include "roomgraph/geometry/cross_matrix.h"

namespace roomgraph {
namespace {

// The pose that `node` moves with, from then on named by it; in whose frame `node` is returned.
Pose3 toBody(NodeId& node, const AttachedPoses& attached) {
  const auto found = attached.find(node);
  if (found == attached.end()) return Pose3::Identity();
  node = found->second.to;
  return found->second.to_from_pose;
}

// With a = a' A, b = b' B and the residual (Ra^T (b - a) - t, 2 vec(R^T Ra^T Rb)) of a movement M = (R, t): the residual of
// A M B^-1 between a' and b' is J times that, as far as it is small.
std::optional<Factor> told(BetweenFactor f, const AttachedPoses& attached) {
  const bool of_two = f.a != f.b;
  const Pose3 a = toBody(f.a, attached), b = toBody(f.b, attached);
  if (of_two && f.a == f.b) return std::nullopt;
  f.a_from_b = a * f.a_from_b * b.inverse();
  Matrix6d jacobian = Matrix6d::Zero();
  jacobian.topLeftCorner<3, 3>() = a.linear();
  jacobian.bottomRightCorner<3, 3>() = b.linear();
  jacobian.topRightCorner<3, 3>() = f.a_from_b.linear() * crossing(b.translation()) * b.linear();
  f.covariance = jacobian * f.covariance * jacobian.transpose();
  return f;
}

std::optional<Factor> told(GroundFactor f, const AttachedPoses& attached) {
  const Pose3 body_from_pose = toBody(f.node, attached);
  f.normal_in_robot = body_from_pose.linear() * f.normal_in_robot;
  f.place_in_robot = body_from_pose * f.place_in_robot;
  return f;
}

std::optional<Factor> told(LandmarkFactor f, const AttachedPoses& attached) {
  const Pose3 body_from_pose = toBody(f.node, attached);
  f.position_in_robot = body_from_pose * f.position_in_robot;
  f.ahead_in_robot = body_from_pose.linear() * f.ahead_in_robot;
  f.covariance = rotateCovariance(f.covariance, body_from_pose.linear());
  return f;
}

std::optional<Factor> told(LandmarkSideFactor f, const AttachedPoses& attached) {
  const Pose3 body_from_pose = toBody(f.node, attached);
  f.point_in_robot = body_from_pose * f.point_in_robot;
  return f;
}

template <class OfCamera>
requires requires(OfCamera f) { f.robot_from_camera; }
std::optional<Factor> told(OfCamera f, const AttachedPoses& attached) {
  const Pose3 body_from_pose = toBody(f.node, attached);
  f.robot_from_camera = body_from_pose * f.robot_from_camera;
  return f;
}

void refuse(NodeId id, const AttachedPoses& attached) {
  if (attached.contains(id))
    throw std::invalid_argument("factor graph: pose " + std::to_string(id.value) + " is attached to another");
}

std::optional<Factor> told(PlanarFactor f, const AttachedPoses& attached) {
  const Pose3 body_from_pose = toBody(f.node, attached);
  f.place_in_robot = body_from_pose * f.place_in_robot;
  f.up_in_robot = body_from_pose.linear() * f.up_in_robot;
  return f;
}

std::optional<Factor> told(const MarginalPrior& f, const AttachedPoses& attached) {
  for (const NodeId id : f.variables.nodes) refuse(id, attached);
  return f;
}

template <class WithoutPoses>
requires(!requires(WithoutPoses f) { f.node; }) std::optional<Factor> told(const WithoutPoses& f, const AttachedPoses&) {
  return f;
}

}  // namespace

std::optional<Factor> toldOfBodies(const Factor& factor, const AttachedPoses& attached) {
  return std::visit([&](const auto& f) { return told(f, attached); }, factor);
}

void FactorGraph::attach(NodeId id, NodeId to, const Pose3& world_from_robot) {
  if (impl_->poses.contains(id) || impl_->attached.contains(id))
    throw std::invalid_argument("factor graph: pose " + std::to_string(id.value) + " added twice");
  refuse(to, impl_->attached);
  impl_->attached[id] = {to, pose(to).inverse() * world_from_robot};
  impl_->bodies.insert(to);
}

NodeId FactorGraph::bodyOf(NodeId id) const {
  const auto found = impl_->attached.find(id);
  return found == impl_->attached.end() ? id : found->second.to;
}

Pose3 FactorGraph::pose(NodeId id) const {
  if (const auto found = impl_->attached.find(id); found != impl_->attached.end())
    return pose(found->second.to) * found->second.to_from_pose;
  const auto& state = impl_->at(id);
  Pose3 pose = Pose3::Identity();
  pose.linear() = Eigen::Quaterniond(state.q.data()).normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(state.t.data());
  return pose;
}

}  // namespace roomgraph
