// SPDX-License-Identifier: BSD-3-Clause
// Ceres problem of a 2D pose graph, with chordal initialisation.
#include "roomgraph/backend/planar_graph.h"

#include <array>
#include <memory>

#include "chordal.h"
#include "planar_residual.h"
#include "solve.h"

namespace roomgraph {
namespace {

using State = std::map<NodeId, std::array<double, 3>>;

State stateOf(const PlanarGraph& graph) {
  State state;
  for (const auto& [id, pose] : graph.poses) state[id] = {pose.x, pose.y, pose.yaw};
  return state;
}

void build(const PlanarGraph& graph, State& state, ceres::Problem& problem) {
  for (auto& [id, values] : state) {
    problem.AddParameterBlock(values.data(), 3);
    if (graph.fixed.contains(id)) problem.SetParameterBlockConstant(values.data());
  }
  for (const auto& edge : graph.edges)
    problem.AddResidualBlock(costOf(edge), nullptr, state.at(edge.a).data(), state.at(edge.b).data());
}

}  // namespace

double chiSquared(const PlanarGraph& graph) {
  State state = stateOf(graph);
  ceres::Problem problem;
  build(graph, state, problem);
  return 2 * costNow(problem);
}

bool initializePoses(PlanarGraph& graph) {
  if (graph.poses.empty() || graph.fixed.size() > 1) return false;
  std::map<NodeId, Pose3> start;
  for (const auto& [id, pose] : graph.poses) start[id] = toPose3(pose);
  std::vector<RelativeEdge> edges;
  for (const auto& edge : graph.edges)
    edges.push_back({edge.a, edge.b, toPose3(edge.a_from_b), edge.information.topLeftCorner<2, 2>().trace(),
                     edge.information(2, 2)});
  const NodeId anchor = graph.fixed.empty() ? start.begin()->first : *graph.fixed.begin();
  const auto relaxed = chordalPoses(start, anchor, edges);
  if (!relaxed) return false;
  PlanarGraph moved = graph;
  for (const auto& [id, pose] : *relaxed)
    if (id != anchor) moved.poses[id] = planarPart(pose);
  if (!(chiSquared(moved) < chiSquared(graph))) return false;
  graph.poses = std::move(moved.poses);
  return true;
}

SolveReport optimize(PlanarGraph& graph, const SolveOptions& options) {
  State state = stateOf(graph);
  ceres::Problem problem;
  build(graph, state, problem);
  SolveReport report = solve(options, solverOptions(options), problem);
  if (report.usable)
    for (const auto& [id, v] : state) graph.poses[id] = {v[0], v[1], wrapAngle(v[2])};
  return report;
}

}  // namespace roomgraph
