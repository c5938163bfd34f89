// SPDX-License-Identifier: BSD-3-Clause
// The classes that the tests of the evaluation know.
#pragma once

#include <map>
#include <string>

#include "roomgraph/evaluation/class_rule.h"

namespace roomgraph::test {

inline std::map<std::string, ClassRule> usualClasses() {
  return {{"swivel_chair", {ShapeKind::kCylinder, 0}},
          {"sofa", {ShapeKind::kCuboid, 1}},
          {"door", {ShapeKind::kPlanar, 2}}};
}

}  // namespace roomgraph::test
