// SPDX-License-Identifier: BSD-3-Clause
// Furniture and door models of simulated worlds.
#pragma once

#include "roomgraph/simulation/mesh.h"
#include "roomgraph/simulation/world.h"

namespace roomgraph {

/// Names of the furniture that can be built.
const std::vector<std::string>& furnitureModels();

struct FurnitureModel {
  std::string class_name;  ///< of the object database, or "other"
  std::string kind;        ///< what it is, in words
  Eigen::Vector3d size_m;  ///< w, d, h
  std::array<double, 3> color;
};

/// Throws std::out_of_range for a name that is not one of furnitureModels().
const FurnitureModel& furnitureModel(const std::string& name);

/// Mesh in the object's frame (bottom centre, x to the front, z up) whose bounding box is exactly d x w x h.
/// `variant` changes details (books, leaves, what a screen shows), `shape` the proportions of seats (0: usual).
Mesh furnitureMesh(const std::string& name, const Eigen::Vector3d& size_m, const std::array<double, 3>& color,
                   int variant, MaterialList& materials, int shape = 0);

/// Moves and stretches a mesh so that its bounding box is d x w x h on the origin.
Mesh fittedMesh(Mesh mesh, const Eigen::Vector3d& size_wdh);

/// Frame and leaf of a door; origin at the bottom centre of the doorway, x out of the wall, the wall's inner
/// face at x = 0 and its outer one at x = -thickness. The leaf opens towards +x.
Mesh doorMesh(const Doorway& doorway, double thickness_m, MaterialList& materials);

}  // namespace roomgraph
