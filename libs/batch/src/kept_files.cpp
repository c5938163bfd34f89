// SPDX-License-Identifier: BSD-3-Clause
// Names of the files of a run by how much is kept.
#include "kept_files.h"

#include <set>

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

const std::set<std::string> kOnlyAll{"live.tum",           "detections.jsonl", "associations_live.jsonl",
                                     "associations.jsonl", "candidates.json",  "graph.g2o",
                                     "timings.csv",        "views.jsonl",      "lost.jsonl"};
const std::set<std::string> kFromMapOn{
    "trajectory.tum", "trajectory_camera.tum", "landmarks.json", "map.pgm", "map.yaml",
    "map.rgmap",      "snapshot.png",          "report.html"};

}  // namespace

void removeUnkept(const fs::path& folder, Keep keep) {
  std::error_code gone_already;
  if (keep != Keep::kAll)
    for (const auto& name : kOnlyAll) fs::remove(folder / name, gone_already);
  if (keep == Keep::kSummary)
    for (const auto& name : kFromMapOn) fs::remove(folder / name, gone_already);
}

std::map<std::string, std::int64_t> filesIn(const fs::path& folder) {
  std::map<std::string, std::int64_t> out;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_regular_file(error) || name == "task.json" || name == "progress" ||
        name.starts_with("result.json"))
      continue;
    out[name] = static_cast<std::int64_t>(entry.file_size(error));
  }
  return out;
}

}  // namespace roomgraph
