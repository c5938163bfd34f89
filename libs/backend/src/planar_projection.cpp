// SPDX-License-Identifier: BSD-3-Clause
// Projection of a 3D factor graph onto the floor plane as a 2D pose graph.
#include "g2o_convention.h"
#include "graph_state.h"
#include "roomgraph/backend/planar_graph.h"

namespace roomgraph {
namespace {

// g2o's error in the plane is expressed in the measured b frame; ours is not (g2o_convention.h).
Eigen::Matrix3d turnedInformation(const Eigen::Matrix3d& information, double measured_yaw) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(measured_yaw).toRotationMatrix();
  return turn.transpose() * information * turn;
}

PlanarEdge edgeOf(const BetweenFactor& movement) {
  PlanarEdge edge{movement.a, movement.b, planarPart(movement.a_from_b)};
  Eigen::Matrix3d covariance;
  constexpr int kRows[] = {0, 1, 5};  // x, y, yaw: marginal over height, roll and pitch
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) covariance(i, j) = movement.covariance(kRows[i], kRows[j]);
  edge.information = turnedInformation(covariance.inverse(), edge.a_from_b.yaw);
  return edge;
}

// Of a covariance of (x, y, z, yaw), without height.
Eigen::Matrix3d planarInformation(const Eigen::Matrix4d& of_place, bool has_yaw) {
  Eigen::Matrix3d covariance;
  constexpr int kRows[] = {0, 1, 3};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) covariance(i, j) = of_place(kRows[i], kRows[j]);
  if (has_yaw) return covariance.inverse();
  Eigen::Matrix3d information = Eigen::Vector3d(0, 0, kTokenInformation).asDiagonal();
  information.topLeftCorner<2, 2>() = covariance.topLeftCorner<2, 2>().inverse();
  return information;
}

PlanarEdge edgeOf(const LandmarkFactor& sighting, NodeId vertex) {
  const double yaw = sighting.has_yaw ? yawInRobot(sighting) : 0;
  const auto& p = sighting.position_in_robot;
  return {sighting.node,
          vertex,
          {p.x(), p.y(), yaw},
          turnedInformation(planarInformation(sighting.covariance / sighting.weight, sighting.has_yaw), yaw)};
}

}  // namespace

PlanarGraph FactorGraph::planar() const {
  PlanarGraph out;
  for (const auto& [id, state] : impl_->poses) {
    out.poses[id] = planarPart(pose(id));
    if (state.fixed) out.fixed.insert(id);
  }
  for (const auto& [id, object] : impl_->objects) {
    const NodeId vertex = impl_->vertexOf(id);
    const LandmarkEstimate estimate = landmark(id);
    out.poses[vertex] = {estimate.position.x(), estimate.position.y(), wrapAngle(estimate.yaw)};
    out.landmarks[vertex] = {id, {object.kind, object.size[0], object.size[1], object.size[2]}};
  }
  for (const auto& entry : impl_->factors)
    if (const auto* movement = std::get_if<BetweenFactor>(&entry.factor))
      out.edges.push_back(edgeOf(*movement));
  for (const auto& entry : impl_->factors) {
    const auto* sighting = std::get_if<LandmarkFactor>(&entry.factor);
    if (sighting && sighting->weight > kLeastWeight)
      out.edges.push_back(edgeOf(*sighting, impl_->vertexOf(sighting->landmark)));
  }
  for (const auto& entry : impl_->factors) {
    const auto* view = std::get_if<LandmarkViewFactor>(&entry.factor);
    if (!view || view->weight <= kLeastWeight) continue;
    const Eigen::Matrix4d covariance = edgeCovariance(*view, landmark(view->landmark).yaw);
    const Eigen::Vector2d offset = offsetOf(*view, landmark(view->landmark).shape);
    out.edges.push_back({impl_->vertexOf(view->landmark), impl_->vertexOf(view->view),
                         Pose2{offset.x(), offset.y(), 0}, planarInformation(covariance, view->has_yaw)});
  }
  return out;
}

}  // namespace roomgraph
