// SPDX-License-Identifier: BSD-3-Clause
// Shape and yaw symmetry of a class, for the comparison of objects.
#pragma once

#include <map>
#include <string>

#include "roomgraph/geometry/shape.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// Properties of a class by which two of its objects are compared.
struct ClassRule {
  ShapeKind shape = ShapeKind::kCuboid;
  int symmetry = 1;  ///< of yaw: 0 any angle, n by 360 deg / n
};

/// The rules of all classes that may become landmarks.
std::map<std::string, ClassRule> classRules(const ObjectDatabase& database);

}  // namespace roomgraph
