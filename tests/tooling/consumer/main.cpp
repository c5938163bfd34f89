// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include <iostream>

#include "roomgraph/evaluation/trajectory_error.h"
#include "roomgraph/observations/object_database.h"

int main(int, char** argv) {
  const auto database = roomgraph::ObjectDatabase::fromFile(argv[1]);
  for (const auto& model : database.models())
    std::cout << model.class_name << " is a " << model.shape << "\n";
  return roomgraph::evaluateTrajectory({}, {}).pairs;
}
