// SPDX-License-Identifier: BSD-3-Clause
// The registration deciders and optimizers that an engine can be made of, MRPT's and ours.
#pragma once

#include <string>
#include <vector>

namespace roomgraph {

enum class DeciderRole { kNode, kEdge, kOptimizer };

/// One class that an engine can be made of.
struct DeciderKind {
  std::string name;
  DeciderRole role;
  bool ours;         ///< needs what `roomgraph run` needs: a configuration, records
  bool in_3d;        ///< all are there for networks of planar poses
  std::string what;  ///< one line
};

/// All of them.
const std::vector<DeciderKind>& deciderKinds();

/// What an engine is made of.
struct EngineParts {
  std::string node;                ///< registers nodes
  std::vector<std::string> edges;  ///< register edges, in this order
  std::string optimizer;
  int dimensions = 2;  ///< of the poses: 2 (x, y, phi) or 3 (x, y, z, yaw, pitch, roll)

  bool anyOfOurs() const;
  bool has(const std::string& name) const;
};

/// "A+B" as edge deciders. Throws ConfigError when a name is empty.
std::vector<std::string> splitEdgeDeciders(const std::string& text);
/// Throws ConfigError, naming `place`, for a name that is none of its role, or not there for these poses.
void checkParts(const EngineParts& parts, const std::string& place);

}  // namespace roomgraph
