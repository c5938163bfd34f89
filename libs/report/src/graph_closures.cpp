// SPDX-License-Identifier: BSD-3-Clause
// Vertices, stamps and edges of a g2o text, as far as loop closures need them.
#include "roomgraph/report/graph_closures.h"

#include <iterator>
#include <map>
#include <sstream>
#include <string>

namespace roomgraph {
namespace {

struct KeyPose {
  double x = 0, y = 0, t = 0;
  bool stamped = false;
};

}  // namespace

std::vector<ClosedLoop> readClosures(std::istream& graph, double start_t) {
  std::map<long, KeyPose> poses;
  std::vector<std::pair<long, long>> edges;
  for (std::string line; std::getline(graph, line);) {
    std::istringstream words(line);
    std::string tag;
    words >> tag;
    long a = 0, b = 0;
    if (tag.starts_with("VERTEX_SE") && words >> a) {
      words >> poses[a].x >> poses[a].y;
    } else if (tag == "#" && words >> tag && tag == "STAMP" && words >> a) {
      poses[a].stamped = static_cast<bool>(words >> poses[a].t);
    } else if (tag.starts_with("EDGE_SE") && words >> a >> b) {
      edges.emplace_back(a, b);
    }
  }
  std::map<long, long> rank;  // key poses in order
  for (const auto& [id, pose] : poses)
    if (pose.stamped) rank.emplace(id, static_cast<long>(rank.size()));
  std::vector<ClosedLoop> closures;
  for (const auto& [a, b] : edges) {
    if (!rank.contains(a) || !rank.contains(b) || std::abs(rank[a] - rank[b]) <= 1) continue;
    const KeyPose &from = poses[a], &to = poses[b];
    closures.push_back({from.t - start_t, to.t - start_t, {from.x, from.y}, {to.x, to.y}});
  }
  return closures;
}

}  // namespace roomgraph
