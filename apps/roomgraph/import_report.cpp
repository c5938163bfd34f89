// SPDX-License-Identifier: BSD-3-Clause
// What imports tell when they are done, and the places of sensors that they are given.
#include <iostream>

#include "import_commands.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph {

SensorPoses posesOf(const std::vector<std::string>& options) {
  SensorPoses poses;
  for (const auto& option : options)
    for (const auto& [label, place] : parseSensorPoses(option, "--pose " + option))
      poses.insert_or_assign(label, place);
  return poses;
}

void tellWarnings(const std::vector<std::string>& warnings) {
  for (const auto& warning : warnings) std::cerr << "roomgraph: warning: " << warning << "\n";
}

void tellImport(const ImportTold& told) {
  std::vector<std::string> counts;
  for (const auto& [label, count] : told.written)
    counts.push_back(std::to_string(count) + " '" + label + "'");
  std::cout << told.rawlog.string() << ": " << join(counts) << "\n";
  for (const auto& [reason, count] : told.skipped)
    std::cout << "left out: " << count << " x " << reason << "\n";
  if (!told.ground_truth.empty())
    std::cout << told.ground_truth.string() << ": ground truth, " << told.truth << "\n";
}

}  // namespace roomgraph
