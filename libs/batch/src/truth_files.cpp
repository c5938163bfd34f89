// SPDX-License-Identifier: BSD-3-Clause
// Search of truth files by the names that the simulator and public data sets use.
#include "truth_files.h"

#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/truth_file.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

bool isRecording(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.ends_with(".rawlog") || name.ends_with(".rawlog.gz");
}

void addIfThere(TruthFiles& truth, const char* kind, const fs::path& file) {
  std::error_code error;
  if (fs::is_regular_file(file, error)) truth.emplace(kind, file);
}

std::string filledIn(std::string text, const std::string& placeholder, const std::string& value) {
  for (auto at = text.find(placeholder); at != std::string::npos;
       at = text.find(placeholder, at + value.size()))
    text.replace(at, placeholder.size(), value);
  return text;
}

}  // namespace

std::string recordingName(const fs::path& rawlog) {
  std::string name = rawlog.filename().string();
  for (const char* ending : {".gz", ".rawlog"})
    if (name.ends_with(ending) && name.size() > std::char_traits<char>::length(ending))
      name.resize(name.size() - std::char_traits<char>::length(ending));
  return name;
}

TruthFiles truthInFolder(const fs::path& folder) {
  TruthFiles truth;
  addIfThere(truth, "trajectory", folder / "groundtruth_robot.txt");
  addIfThere(truth, "camera_trajectory", folder / "groundtruth.txt");
  addIfThere(truth, "objects", folder / "objects.json");
  addIfThere(truth, "boxes", folder / "boxes.jsonl");
  addIfThere(truth, "map", folder / "map_truth.yaml");
  return truth;
}

TruthFiles truthBeside(const fs::path& rawlog) {
  const fs::path folder = rawlog.parent_path();
  int recordings = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) recordings += isRecording(entry.path());
  TruthFiles truth = recordings == 1 ? truthInFolder(folder) : TruthFiles();
  // What an import wrote counts, not what it read: that may be in another frame.
  if (const fs::path imported = folder / (recordingName(rawlog) + ".groundtruth.txt"); const auto whose = whoseTruth(imported)) {
    truth.erase("trajectory");
    truth.erase("camera_trajectory");
    truth.emplace(*whose == TruthOf::kRobot ? "trajectory" : "camera_trajectory", imported);
  }
  addIfThere(truth, "trajectory", rawlog.string() + ".GT.txt");
  addIfThere(truth, "relations", folder / (recordingName(rawlog) + ".relations"));
  return truth;
}

TruthFiles namedTruth(const InputEntry& entry, const fs::path& rawlog) {
  TruthFiles truth;
  for (const auto& [kind, pattern] : entry.truth) {
    const fs::path file = filledIn(filledIn(pattern, "{folder}", rawlog.parent_path().string()), "{name}",
                                   recordingName(rawlog));
    if (kind == "folder") {
      truth = truthInFolder(file);
      if (truth.empty())
        throw InputError(entry.place + ": truth: " + file.string() + " is no folder with truth files");
      continue;
    }
    if (!fs::is_regular_file(file))
      throw InputError(entry.place + ": truth." + kind + ": " + file.string() + ": no such file (for " +
                       rawlog.string() + ")");
    truth[kind] = file;
  }
  return truth;
}

}  // namespace roomgraph
