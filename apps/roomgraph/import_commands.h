// SPDX-License-Identifier: BSD-3-Clause
// Sub-commands of `import` for recordings of other programs, and what all of them tell.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "roomgraph/datasets/sensor_poses.h"
#include "roomgraph/geometry/camera.h"

namespace roomgraph {

/// `import carmen`.
void addImportCarmen(CLI::App& importer);
/// `import rtabmap`.
void addImportRtabmap(CLI::App& importer);

/// `import openloris`.
void addImportOpenloris(CLI::App& importer);

/// --camera: a published camera's name, or "fx,fy,cx,cy" in pixels, with size 0. Throws ConfigError.
PinholeCamera cameraOption(const std::string& text);

/// Places given as --pose LABEL=x,y,z,yaw,pitch,roll; of two for one label the last one counts. Throws
/// ConfigError.
SensorPoses posesOf(const std::vector<std::string>& options);

void tellWarnings(const std::vector<std::string>& warnings);  ///< on stderr

struct ImportTold {
  std::filesystem::path rawlog;
  const std::map<std::string, int>& written;  ///< records by label
  const std::map<std::string, int>& skipped;  ///< by reason
  std::filesystem::path ground_truth;         ///< empty: none
  std::string truth;                          ///< what it is
};
/// What was written, on stdout.
void tellImport(const ImportTold& told);

}  // namespace roomgraph
