// SPDX-License-Identifier: BSD-3-Clause
// Program outside the project that uses the installed libraries.
#include <iostream>

#include "roomgraph/evaluation/trajectory_error.h"
#include "roomgraph/observations/object_database.h"

int main(int, char** argv) {
  const auto database = roomgraph::ObjectDatabase::fromFile(argv[1]);
  for (const auto& model : database.models())
    std::cout << model.class_name << " is a " << model.shape << "\n";
  return roomgraph::evaluateTrajectory({}, {}).pairs;
}
