// SPDX-License-Identifier: BSD-3-Clause
// Vertices, stamps, edges and kinds of a g2o text, as far as loop closures need them.
#include "roomgraph/report/graph_closures.h"

#include <cmath>
#include <deque>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {
namespace {

using Numbers = std::vector<double>;
using Ends = std::pair<long, long>;

struct KeyPose {
  Numbers pose;  // x y yaw, or x y z qx qy qz qw
  double t = 0;
  bool stamped = false;
};

struct Edge {
  Ends ends;
  Numbers numbers;  // movement, then the upper triangle of the information
};

struct Graph {
  std::map<long, KeyPose> poses;
  std::vector<Edge> edges;
  std::map<Ends, std::deque<std::string>> kinds;  // of the edges of a pair, in order
};

Numbers restOf(std::istringstream& words) {
  return {std::istream_iterator<double>(words), {}};
}

void readComment(std::istringstream& words, Graph& graph) {
  std::string word;
  long a = 0, b = 0;
  words >> word;
  if (word == "STAMP" && words >> a)
    graph.poses[a].stamped = static_cast<bool>(words >> graph.poses[a].t);
  else if (word == "CLOSURE" && words >> a >> b >> word)
    graph.kinds[{a, b}].push_back(word);
}

Graph read(std::istream& text) {
  Graph graph;
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string tag;
    words >> tag;
    long a = 0, b = 0;
    if (tag == "#")
      readComment(words, graph);
    else if (tag.starts_with("VERTEX_SE") && words >> a)
      graph.poses[a].pose = restOf(words);
    else if (tag.starts_with("EDGE_SE") && words >> a >> b)
      graph.edges.push_back({{a, b}, restOf(words)});
  }
  return graph;
}

Pose3 poseOf(const double* n, bool planar) {
  if (planar) return toPose3(Pose2{n[0], n[1], n[2]});
  Pose3 pose = Pose3::Identity();
  pose.translation() = Eigen::Vector3d(n[0], n[1], n[2]);
  pose.linear() = Eigen::Quaterniond(n[6], n[3], n[4], n[5]).normalized().toRotationMatrix();
  return pose;
}

// (x, y, yaw), or (x, y, z, qx, qy, qz) with qw >= 0.
Eigen::VectorXd errorOf(const Pose3& off, bool planar) {
  if (planar) {
    const Pose2 flat = planarPart(off);
    return Eigen::Vector3d(flat.x, flat.y, flat.yaw);
  }
  Eigen::Quaterniond q(off.linear());
  if (q.w() < 0) q.coeffs() *= -1;
  Eigen::VectorXd error(6);
  error << off.translation(), q.vec();
  return error;
}

double weighed(const Eigen::VectorXd& error, const double* triangle) {
  double sum = 0;
  for (Eigen::Index i = 0; i < error.size(); ++i)
    for (Eigen::Index j = i; j < error.size(); ++j)
      sum += (i == j ? 1 : 2) * error(i) * error(j) * *triangle++;
  return std::sqrt(std::max(0.0, sum));
}

void addResidual(const Edge& edge, const Numbers& a, const Numbers& b, ClosedLoop& loop) {
  const bool planar = a.size() == 3;
  const std::size_t movement = planar ? 3 : 7, information = planar ? 6 : 21;
  loop.off_m = loop.off_rad = loop.off_sigmas = std::numeric_limits<double>::quiet_NaN();
  if (a.size() != movement || b.size() != movement || edge.numbers.size() != movement + information) return;
  const Pose3 off = poseOf(edge.numbers.data(), planar).inverse() * poseOf(a.data(), planar).inverse() *
                    poseOf(b.data(), planar);
  loop.off_m = off.translation().norm();
  loop.off_rad = rotationAngle(off);
  loop.off_sigmas = weighed(errorOf(off, planar), edge.numbers.data() + movement);
}

std::array<double, 2> placeOf(const Numbers& pose) {
  return {pose.empty() ? 0 : pose[0], pose.size() < 2 ? 0 : pose[1]};
}

}  // namespace

std::vector<ClosedLoop> readClosures(std::istream& text, double start_t) {
  Graph graph = read(text);
  std::map<long, long> rank;  // key poses in order
  for (const auto& [id, pose] : graph.poses)
    if (pose.stamped) rank.emplace(id, static_cast<long>(rank.size()));
  std::vector<ClosedLoop> closures;
  for (const Edge& edge : graph.edges) {
    const auto [a, b] = edge.ends;
    if (!rank.contains(a) || !rank.contains(b) || std::abs(rank[a] - rank[b]) <= 1) continue;
    const KeyPose &from = graph.poses[a], &to = graph.poses[b];
    ClosedLoop loop{
        from.t - start_t, to.t - start_t, placeOf(from.pose), placeOf(to.pose), a, b, "", 0, 0, 0};
    if (auto& kinds = graph.kinds[edge.ends]; !kinds.empty()) {
      loop.kind = kinds.front();
      kinds.pop_front();
    }
    addResidual(edge, from.pose, to.pose, loop);
    closures.push_back(std::move(loop));
  }
  return closures;
}

}  // namespace roomgraph
