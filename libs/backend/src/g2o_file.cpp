// SPDX-License-Identifier: BSD-3-Clause
// g2o writer: vertices and edges, with times and landmark shapes as comments.
#include "roomgraph/backend/g2o_file.h"

#include <array>
#include <cstdio>
#include <limits>
#include <sstream>

#include "g2o_convention.h"
#include "graph_state.h"
#include "roomgraph/core/output_file.h"

namespace roomgraph {
namespace {

// With as many digits as a double needs to be read back exactly.
std::ostringstream exactText() {
  std::ostringstream out;
  out.precision(std::numeric_limits<double>::max_digits10);
  return out;
}

void writeTransform(std::ostream& out, const Pose3& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  out << ' ' << t.x() << ' ' << t.y() << ' ' << t.z() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << ' '
      << q.w();
}

template <int N>
void writeUpper(std::ostream& out, const Eigen::Matrix<double, N, N>& information) {
  for (int i = 0; i < N; ++i)
    for (int j = i; j < N; ++j) out << ' ' << information(i, j);
  out << '\n';
}

// To the microsecond, as in trajectory files.
void writeTime(std::ostream& out, NodeId vertex, const NodeTimes& times) {
  const auto found = times.find(vertex);
  if (found == times.end()) return;
  char text[64];
  std::snprintf(text, sizeof text, "%.6f", found->second);
  out << "# STAMP " << vertex << ' ' << text << '\n';
}

void writeLandmark(std::ostream& out, NodeId vertex, LandmarkId id, const ObjectShape& shape) {
  out << "# LANDMARK " << vertex << ' ' << id << ' ' << toString(shape.kind) << ' ' << shape.width << ' '
      << shape.depth << ' ' << shape.height << '\n';
}

// A landmark's measurement observes x, y, z and perhaps yaw; the rest gets a small weight, as readers demand a
// positive definite matrix.
Matrix6d informationOf(const Pose3& measured, Eigen::Matrix4d covariance, bool has_yaw) {
  if (!has_yaw) {
    covariance.row(3).setZero();
    covariance.col(3).setZero();
    covariance(3, 3) = 1;
  }
  Matrix6d wide = Matrix6d::Identity();
  constexpr std::array<int, 4> kRows{0, 1, 2, 5};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) wide(kRows[i], kRows[j]) = covariance(i, j);
  Matrix6d information = g2oInformation(measured, wide);
  for (int i : {3, 4}) information(i, i) = kTokenInformation;
  if (!has_yaw) information(5, 5) = kTokenInformation;
  return information;
}

}  // namespace

void FactorGraph::saveG2o(const std::filesystem::path& file, const NodeTimes& times) const {
  std::ostringstream out = exactText();
  for (const auto& [id, state] : impl_->poses) {
    writeTime(out, id, times);
    out << "VERTEX_SE3:QUAT " << id;
    writeTransform(out, pose(id));
    out << '\n';
    if (state.fixed) out << "FIX " << id << '\n';
  }
  for (const auto& [id, object] : impl_->objects) {
    const LandmarkEstimate estimate = landmark(id);
    const auto& p = estimate.position;
    const auto& [width, depth, height] = object.size;
    writeLandmark(out, impl_->vertexOf(id), id, {object.kind, width, depth, height});
    out << "VERTEX_SE3:QUAT " << impl_->vertexOf(id);
    writeTransform(out, poseFromYpr(p.x(), p.y(), p.z(), estimate.yaw, 0, 0));
    out << '\n';
  }
  for (const auto& entry : impl_->factors) {
    if (const auto* movement = std::get_if<BetweenFactor>(&entry.factor)) {
      out << "EDGE_SE3:QUAT " << movement->a << ' ' << movement->b;
      writeTransform(out, movement->a_from_b);
      writeUpper<6>(out, g2oInformation(movement->a_from_b, movement->covariance));
    }
  }
  for (const auto& entry : impl_->factors) {
    const auto* sighting = std::get_if<LandmarkFactor>(&entry.factor);
    if (sighting && sighting->weight > kLeastWeight) {
      out << "EDGE_SE3:QUAT " << sighting->node << ' ' << impl_->vertexOf(sighting->landmark);
      writeTransform(out, measuredTransform(*sighting));
      writeUpper<6>(out, informationOf(measuredTransform(*sighting), sighting->covariance / sighting->weight,
                                       sighting->has_yaw));
    }
  }
  for (const auto& entry : impl_->factors) {
    const auto* view = std::get_if<LandmarkViewFactor>(&entry.factor);
    if (!view || view->weight <= kLeastWeight) continue;
    out << "EDGE_SE3:QUAT " << impl_->vertexOf(view->landmark) << ' ' << impl_->vertexOf(view->view);
    const Eigen::Vector2d offset = offsetOf(*view, landmark(view->landmark).shape);
    const Pose3 edge = toPose3(Pose2{offset.x(), offset.y(), 0});
    writeTransform(out, edge);
    const Eigen::Matrix4d covariance = edgeCovariance(*view, landmark(view->landmark).yaw);
    writeUpper<6>(out, informationOf(edge, covariance, view->has_yaw));
  }
  writeFileAtomically(file, out.str());
}

void saveG2o(const PlanarGraph& graph, const std::filesystem::path& file, const NodeTimes& times) {
  std::ostringstream out = exactText();
  for (const auto& [id, pose] : graph.poses) {
    writeTime(out, id, times);
    if (const auto object = graph.landmarks.find(id); object != graph.landmarks.end())
      writeLandmark(out, id, object->second.id, object->second.shape);
    out << "VERTEX_SE2 " << id << ' ' << pose.x << ' ' << pose.y << ' ' << pose.yaw << '\n';
    if (graph.fixed.contains(id)) out << "FIX " << id << '\n';
  }
  for (const auto& edge : graph.edges) {
    const Pose2& p = edge.a_from_b;
    out << "EDGE_SE2 " << edge.a << ' ' << edge.b << ' ' << p.x << ' ' << p.y << ' ' << p.yaw;
    writeUpper<3>(out, edge.information);
  }
  writeFileAtomically(file, out.str());
}

}  // namespace roomgraph
