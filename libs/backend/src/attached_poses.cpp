// SPDX-License-Identifier: BSD-3-Clause
// Change of frame of every kind of factor, from a pose to the one that it moves with.
#include "attached_poses.h"

#include <stdexcept>

#include "cross_matrix.h"
#include "graph_state.h"
#include "roomgraph/geometry/covariance.h"

namespace roomgraph {
namespace {

AttachedPose bodyOf(NodeId id, const AttachedPoses& attached) {
  const auto found = attached.find(id);
  return found == attached.end() ? AttachedPose{id} : found->second;
}

// With a = a' A, b = b' B and the residual (Ra^T (b - a) - t, 2 vec(R^T Ra^T Rb)) of a movement M = (R, t): the residual of
// A M B^-1 between a' and b' is J times that, as far as it is small.
std::optional<Factor> told(BetweenFactor f, const AttachedPoses& attached) {
  const AttachedPose a = bodyOf(f.a, attached), b = bodyOf(f.b, attached);
  if (a.to == b.to && f.a != f.b) return std::nullopt;
  f.a = a.to;
  f.b = b.to;
  f.a_from_b = a.to_from_pose * f.a_from_b * b.to_from_pose.inverse();
  Matrix6d jacobian = Matrix6d::Zero();
  jacobian.topLeftCorner<3, 3>() = a.to_from_pose.linear();
  jacobian.bottomRightCorner<3, 3>() = b.to_from_pose.linear();
  jacobian.topRightCorner<3, 3>() = f.a_from_b.linear() * crossing(b.to_from_pose.translation()) * b.to_from_pose.linear();
  f.covariance = jacobian * f.covariance * jacobian.transpose();
  return f;
}

std::optional<Factor> told(GroundFactor f, const AttachedPoses& attached) {
  const AttachedPose body = bodyOf(f.node, attached);
  f.node = body.to;
  f.normal_in_robot = body.to_from_pose.linear() * f.normal_in_robot;
  f.place_in_robot = body.to_from_pose * f.place_in_robot;
  return f;
}

std::optional<Factor> told(LandmarkFactor f, const AttachedPoses& attached) {
  const AttachedPose body = bodyOf(f.node, attached);
  f.node = body.to;
  f.position_in_robot = body.to_from_pose * f.position_in_robot;
  f.ahead_in_robot = body.to_from_pose.linear() * f.ahead_in_robot;
  f.covariance = rotateCovariance(f.covariance, body.to_from_pose.linear());
  return f;
}

std::optional<Factor> told(LandmarkSideFactor f, const AttachedPoses& attached) {
  const AttachedPose body = bodyOf(f.node, attached);
  f.node = body.to;
  f.point_in_robot = body.to_from_pose * f.point_in_robot;
  return f;
}

template <class OfCamera>
requires requires(OfCamera f) { f.robot_from_camera; }
std::optional<Factor> told(OfCamera f, const AttachedPoses& attached) {
  const AttachedPose body = bodyOf(f.node, attached);
  f.node = body.to;
  f.robot_from_camera = body.to_from_pose * f.robot_from_camera;
  return f;
}

void refuse(NodeId id, const AttachedPoses& attached) {
  if (attached.contains(id))
    throw std::invalid_argument("factor graph: pose " + std::to_string(id.value) + " is attached to another");
}

std::optional<Factor> told(PlanarFactor f, const AttachedPoses& attached) {
  const AttachedPose body = bodyOf(f.node, attached);
  f.node = body.to;
  f.place_in_robot = body.to_from_pose * f.place_in_robot;
  f.up_in_robot = body.to_from_pose.linear() * f.up_in_robot;
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
}

bool FactorGraph::isAttached(NodeId id) const { return impl_->attached.contains(id); }

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
