// SPDX-License-Identifier: BSD-3-Clause
// Division of the key poses into local maps, and the factors of these.
#include "local_maps.h"

#include <algorithm>
#include <utility>

namespace roomgraph {
namespace {

const NodeId kFirstOfImages{10'000'000}, kFirstOfScans{20'000'000};
constexpr double kMatchRobustWidth = 3;  // Cauchy, in standard deviations: a wrong match is rare

// Whether its key poses are some of those of a longer body.
bool movesAlong(const FactorGraph& graph, const std::vector<KeyPose>& nodes, const LocalMap& map) {
  const NodeId begin = nodes[map.first].id, body = graph.bodyOf(begin);
  if (graph.bodyOf(nodes[map.end - 1].id) != body) return false;
  return body != begin || (map.end < nodes.size() && graph.bodyOf(nodes[map.end].id) == body);
}

void addFactors(FactorGraph& graph, const KeyPoses& poses, const MotionSource& source,
                const std::vector<LocalMap>& maps, std::size_t since) {
  const auto& nodes = poses.nodes();
  Matrix6d within = Matrix6d::Zero();  // drift within the body: where it ends, all of it gives way
  for (std::size_t k = 0; k < maps.size(); ++k) {
    const LocalMap& map = maps[k];
    const KeyPose& begin = nodes[map.first];
    const double begin_t = begin.t;
    if (movesAlong(graph, nodes, map))
      graph.attach(map.id, graph.bodyOf(begin.id), begin.world_from_robot);
    else
      graph.addPose(map.id, begin.world_from_robot);
    if (k > 0 && map.follows) {
      const Movement moved = source.betweenLocalMaps(nodes[maps[k - 1].first].t, begin_t, kSourceGap_s).value();
      within += moved.covariance;
      if (graph.bodyOf(maps[k - 1].id) != graph.bodyOf(map.id))
        graph.add(BetweenFactor{maps[k - 1].id, map.id, moved.a_from_b, std::exchange(within, Matrix6d::Zero()), kMatchRobustWidth});
    } else {
      within.setZero();
    }
    for (std::size_t i = std::max(map.first, since); i < map.end; ++i) {
      const Movement seen = source.inLocalMap(begin_t, nodes[i].t, kSourceGap_s).value();
      graph.add(BetweenFactor{map.id, nodes[i].id, seen.a_from_b, seen.covariance, kMatchRobustWidth});
    }
  }
}

}  // namespace

bool isLocalMap(NodeId id) {
  return id >= kFirstOfImages && id.value < 2 * kFirstOfScans.value;
}

std::vector<LocalMap> localMaps(const KeyPoses& poses, const MotionSource& source, NodeId first_id,
                                std::size_t since, const BackendOptions& options) {
  const auto& nodes = poses.nodes();
  const auto length = static_cast<std::size_t>(options.local_map_nodes);
  const auto covers = [&](std::size_t a, std::size_t b) {
    return source.between(nodes[a].t, nodes[b].t, kSourceGap_s).has_value();
  };
  std::vector<LocalMap> maps;
  bool open = false;  // the last one goes on
  for (std::size_t i = since - since % length; i < nodes.size(); ++i) {
    const bool follows = open && covers(maps.back().first, i);
    open = follows || covers(i, i);
    if (!open) continue;
    if (!follows || i % length == 0)
      maps.push_back({NodeId{first_id.value + nodes[i].id.value}, i, i, follows});
    maps.back().end = i + 1;
  }
  maps.erase(maps.begin(),
             std::find_if(maps.begin(), maps.end(), [&](const LocalMap& map) { return map.end > since; }));
  return maps;
}

std::vector<LocalMap> addLocalMaps(FactorGraph& graph, const KeyPoses& poses, const Motion& motion,
                                   std::size_t since, const BackendOptions& options) {
  std::vector<LocalMap> all;
  for (const auto& [source, first_id] :
       {std::pair{&motion.visual, kFirstOfImages}, {&motion.lidar, kFirstOfScans}}) {
    const std::vector<LocalMap> maps = localMaps(poses, *source, first_id, since, options);
    addFactors(graph, poses, *source, maps, since);
    all.insert(all.end(), maps.begin(), maps.end());
  }
  return all;
}

}  // namespace roomgraph
