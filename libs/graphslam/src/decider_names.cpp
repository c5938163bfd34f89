// SPDX-License-Identifier: BSD-3-Clause
// Table of the deciders and optimizers, and checks of names against it.
#include "roomgraph/graphslam/decider_names.h"

#include <algorithm>
#include <sstream>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph {
namespace {

const char* keyOf(DeciderRole role) {
  if (role == DeciderRole::kNode) return "node_registration_decider";
  return role == DeciderRole::kEdge ? "edge_registration_decider" : "optimizer";
}

void checkName(const std::string& name, DeciderRole role, int dimensions, const std::string& place) {
  if (name == "CLoopCloserERD" && role == DeciderRole::kEdge)
    throw ConfigError(place + ": edge_registration_decider = CLoopCloserERD: MRPT 2.5's ends the program by a segmentation fault, in MRPT's "
                      "own graphslam-engine, too; take CICPCriteriaERD or CScanClosuresERD");
  std::vector<std::string> known;
  for (const auto& kind : deciderKinds()) {
    if (kind.role != role || (dimensions == 3 && !kind.in_3d)) continue;
    if (kind.name == name) return;
    known.push_back(kind.name);
  }
  const bool only_2d = std::any_of(deciderKinds().begin(), deciderKinds().end(),
                                   [&](const auto& kind) { return kind.name == name && kind.role == role; });
  throw ConfigError(place + ": " + keyOf(role) + " = " + name +
                    (only_2d ? ": is there for planar poses alone" : ": there is none" + didYouMean(name, known)) +
                    "; known" + (dimensions == 3 ? " in 3D: " : ": ") + join(known));
}

}  // namespace

const std::vector<DeciderKind>& deciderKinds() {
  using enum DeciderRole;
  static const std::vector<DeciderKind> kinds = {
      {"CFixedIntervalsNRD", kNode, false, true, "MRPT: a node every so many metres or degrees of odometry"},
      {"CICPCriteriaNRD", kNode, false, false, "MRPT: the same, by ICP of scans"},
      {"CEmptyNRD", kNode, false, true, "MRPT: none"},
      {"CKeyPosesNRD", kNode, true, true, "key poses of scan matching, RGB-D odometry and wheels"},
      {"CICPCriteriaERD", kEdge, false, false, "MRPT: ICP of scans against nodes nearby"},
      {"CEmptyERD", kEdge, false, true, "MRPT: none"},
      {"CScanClosuresERD", kEdge, true, true, "loops closed by scans against submaps"},
      {"CImageClosuresERD", kEdge, true, true, "loops closed by images"},
      {"CObjectClosuresERD", kEdge, true, true, "loops closed by objects; objects as annotations of the nodes"},
      {"CLevMarqGSO", kOptimizer, false, true, "MRPT: Levenberg-Marquardt"},
      {"CEmptyGSO", kOptimizer, false, true, "MRPT: none"},
      {"CFactorGraphGSO", kOptimizer, true, true, "factor graph with robust losses on loop closures"},
  };
  return kinds;
}

bool EngineParts::has(const std::string& name) const {
  return name == node || name == optimizer || std::find(edges.begin(), edges.end(), name) != edges.end();
}

bool EngineParts::anyOfOurs() const {
  return std::any_of(deciderKinds().begin(), deciderKinds().end(),
                     [this](const auto& kind) { return kind.ours && has(kind.name); });
}

std::vector<std::string> splitEdgeDeciders(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string name; std::getline(in, name, '+');) out.push_back(name);
  if (text.empty() || text.back() == '+' || std::find(out.begin(), out.end(), "") != out.end())
    throw ConfigError("edge_registration_decider = " + text + ": a name is missing; names are joined by +");
  return out;
}

void checkParts(const EngineParts& parts, const std::string& place) {
  if (parts.dimensions != 2 && parts.dimensions != 3)
    throw ConfigError(place + ": dimensions = " + std::to_string(parts.dimensions) + ": must be 2 or 3");
  checkName(parts.node, DeciderRole::kNode, parts.dimensions, place);
  for (std::size_t i = 0; i < parts.edges.size(); ++i) {
    checkName(parts.edges[i], DeciderRole::kEdge, parts.dimensions, place);
    if (std::find(parts.edges.begin(), parts.edges.begin() + static_cast<std::ptrdiff_t>(i), parts.edges[i]) !=
        parts.edges.begin() + static_cast<std::ptrdiff_t>(i))
      throw ConfigError(place + ": edge_registration_decider: " + parts.edges[i] + " is named twice");
  }
  checkName(parts.optimizer, DeciderRole::kOptimizer, parts.dimensions, place);
}

}  // namespace roomgraph
