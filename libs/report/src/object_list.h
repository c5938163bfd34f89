// SPDX-License-Identifier: BSD-3-Clause
// Objects of a run as its JSON files describe them.
#pragma once

#include <filesystem>

#include "run_data.h"

namespace roomgraph {

/// The objects of landmarks.json or candidates.json, and the name of the recording.
struct ObjectFile {
  std::string recording, version;
  std::vector<ReportedObject> objects;
};

/// Throws InputError naming file, object and cause.
ObjectFile readObjectFile(const std::filesystem::path& file);

/// Those of the map, then the candidates that are not in it.
std::vector<ReportedObject> merged(std::vector<ReportedObject> mapped,
                                   std::vector<ReportedObject> candidates);

}  // namespace roomgraph
