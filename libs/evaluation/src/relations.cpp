// SPDX-License-Identifier: BSD-3-Clause
// Reader of relation files and errors of the interpolated estimate.
#include "roomgraph/evaluation/relations.h"

#include "number_table.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {

std::vector<Relation> readRelations(const std::filesystem::path& file) {
  std::vector<Relation> relations;
  for (const auto& row : readNumberTable(file)) {
    const auto& v = row.values;
    if (v.size() != 8)
      throw InputError(row.place + ": expected 8 columns (t1 t2 x y z roll pitch yaw), got " +
                       std::to_string(v.size()));
    relations.push_back({v[0], v[1], poseFromYpr(v[2], v[3], v[4], v[7], v[6], v[5])});
  }
  if (relations.empty()) throw InputError(file.string() + ": holds no relation");
  return relations;
}

RelationErrors evaluateRelations(const std::vector<Relation>& relations, const Trajectory& estimate,
                                 const RelationOptions& options) {
  RelationErrors out;
  std::vector<double> trans, rot;
  for (const auto& relation : relations) {
    const auto x1 = estimate.at(relation.t1, options.max_extrapolation_s);
    const auto x2 = estimate.at(relation.t2, options.max_extrapolation_s);
    if (!x1 || !x2) {
      ++out.missing;
      continue;
    }
    const Pose3 error = relation.pose.inverse() * (x1->inverse() * *x2);
    trans.push_back(error.translation().norm());
    rot.push_back(rotationAngle(error) * kDegreesPerRadian);
  }
  out.used = static_cast<int>(trans.size());
  out.trans_m = summarize(trans);
  out.rot_deg = summarize(rot);
  return out;
}

}  // namespace roomgraph
