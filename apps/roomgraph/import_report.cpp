// SPDX-License-Identifier: BSD-3-Clause
// What imports tell when they are done, and the cameras and places of sensors that they are given.
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "import_commands.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/datasets/camera_presets.h"

namespace roomgraph {

PinholeCamera cameraOption(const std::string& text) {
  if (const auto preset = findCameraPreset(text)) {
    PinholeCamera camera = preset->camera;
    camera.fy = std::abs(camera.fy);
    return camera;
  }
  std::array<double, 4> v{};
  int used = 0;
  const bool numbers = std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf%n", &v[0], &v[1], &v[2], &v[3], &used) == 4;
  if (!numbers || text.size() != static_cast<std::size_t>(used) || !(v[0] > 0) || !(v[1] > 0))
    throw ConfigError("--camera " + text + ": give FX,FY,CX,CY in pixels, or one of " + presetNames());
  return {0, 0, v[0], v[1], v[2], v[3], {}};
}

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
