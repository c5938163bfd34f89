// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include <fstream>
#include <limits>

#include "graph_state.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

void writeTransform(std::ostream& out, const Pose3& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  out << ' ' << t.x() << ' ' << t.y() << ' ' << t.z() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << ' '
      << q.w();
}

void writeUpper(std::ostream& out, const Matrix6d& information) {
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) out << ' ' << information(i, j);
  out << '\n';
}

// A landmark's measurement fixes x, y, z and perhaps yaw; roll and pitch get a token weight to keep readers
// happy.
Matrix6d informationOf(const LandmarkFactor& factor) {
  Matrix6d information = 1e-3 * Matrix6d::Identity();
  const Eigen::Matrix4d full = factor.weight * factor.covariance.inverse();
  information.topLeftCorner<3, 3>() =
      factor.has_yaw ? Eigen::Matrix3d(full.topLeftCorner<3, 3>())
                     : Eigen::Matrix3d(factor.weight * factor.covariance.topLeftCorner<3, 3>().inverse());
  if (factor.has_yaw) information(5, 5) = full(3, 3);
  return information;
}

}  // namespace

void FactorGraph::saveG2o(const std::filesystem::path& file) const {
  std::ofstream out(file);
  out.precision(std::numeric_limits<double>::max_digits10);
  const std::int64_t first_landmark = impl_->poses.empty() ? 0 : impl_->poses.rbegin()->first.value + 1;
  for (const auto& [id, state] : impl_->poses) {
    out << "VERTEX_SE3:QUAT " << id;
    writeTransform(out, pose(id));
    out << '\n';
    if (state.fixed) out << "FIX " << id << '\n';
  }
  for (const auto& [id, object] : impl_->objects) {
    const auto& v = object.value;
    out << "VERTEX_SE3:QUAT " << first_landmark + id.value;
    writeTransform(out, poseFromYpr(v[0], v[1], v[2], v[3], 0, 0));
    out << '\n';
  }
  for (const auto& factor : impl_->between) {
    out << "EDGE_SE3:QUAT " << factor.a << ' ' << factor.b;
    writeTransform(out, factor.a_from_b);
    writeUpper(out, factor.covariance.inverse());
  }
  for (const auto& factor : impl_->sightings) {
    const auto& p = factor.position_in_robot;
    out << "EDGE_SE3:QUAT " << factor.node << ' ' << first_landmark + factor.landmark.value;
    writeTransform(out, poseFromYpr(p.x(), p.y(), p.z(), factor.has_yaw ? factor.yaw_in_robot : 0, 0, 0));
    writeUpper(out, informationOf(factor));
  }
  if (!out) throw RunError(file.string() + ": cannot be written");
}

}  // namespace roomgraph
