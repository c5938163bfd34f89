// SPDX-License-Identifier: BSD-3-Clause
// Two networks of which each finds what the other does not, one of them on fewer images.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "program.h"

namespace roomgraph::test {

/// The shipped network twice, in folders of its own below `folder`: one for doors, twice a second, one for all else, five times a
/// second. Words of a command line.
inline std::vector<std::string> ratedNetworks(const std::filesystem::path& folder) {
  const std::filesystem::path shipped = ROOMGRAPH_SOURCE_DIR "/models/room_detector";
  std::string models;
  for (const std::string name : {"seats", "doors"}) {
    std::filesystem::create_directories(folder / name);
    std::filesystem::copy_file(shipped / "room_detector.onnx", folder / name / "network.onnx");
    std::ofstream labels(folder / name / "labels.txt");
    for (const std::string& label : linesOf(contentOf(shipped / "labels.txt")))
      labels << ((label == "door") == (name == "doors") ? label : "no " + label) << "\n";
    models += (models.empty() ? "" : ",") + (folder / name / "network.onnx").string() + (name == "doors" ? "@2" : "@5");
  }
  return {"--set", "detection.class=DnnDetector", "--set", "detection.models=" + models};
}

}  // namespace roomgraph::test
