// SPDX-License-Identifier: BSD-3-Clause
// Patterns to files, and names that are unique and stay the same.
#include "roomgraph/batch/plan.h"

#include <glob.h>

#include <algorithm>
#include <map>
#include <set>

#include "roomgraph/catalogue/run_result.h"
#include "roomgraph/core/errors.h"
#include "truth_files.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> filesOf(const std::string& pattern, const std::string& place) {
  if (fs::is_regular_file(pattern)) return {pattern};  // of whatever name
  glob_t found{};
  const int outcome = glob(pattern.c_str(), 0, nullptr, &found);
  std::vector<fs::path> files(found.gl_pathv, found.gl_pathv + (outcome == 0 ? found.gl_pathc : 0));
  globfree(&found);
  std::erase_if(files, [](const fs::path& file) { return !fs::is_regular_file(file); });
  if (files.empty())
    throw InputError((place.empty() || place == pattern ? "" : place + ": ") + pattern + ": no such file" +
                     (fs::is_directory(pattern)
                          ? "; it is a folder: name the recordings in it, like '" + pattern + "/*.rawlog'"
                          : ""));
  return files;
}

std::string plainName(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) &&
        std::string_view("_-.+").find(c) == std::string_view::npos)
      c = '_';
  return name.empty() || name.front() == '.' ? "_" + name : name;
}

// The name of the file, with so many of its folders in front.
std::string nameWithFolders(const fs::path& file, int folders) {
  std::string name = plainName(recordingName(file));
  fs::path folder = file.parent_path();
  for (; folders > 0 && folder.has_filename(); --folders, folder = folder.parent_path())
    name = plainName(folder.filename().string()) + "_" + name;
  return name;
}

constexpr int kMostFolders = 40;

std::string numbered(const std::string& name, const std::set<std::string>& taken) {
  std::string out = name;
  for (int number = 2; taken.contains(out); ++number) out = name + "_" + std::to_string(number);
  return out;
}

// Files of recordings by the names under which a folder has results of them.
std::map<std::string, fs::path> earlierRecordings(const fs::path& folder) {
  std::map<std::string, fs::path> out;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder / "runs", none)) {
    try {
      const RunInput input = readRunResult(entry.path() / "result.json").input;
      out[input.name] = input.path;
    } catch (const InputError&) {  // no whole run
    }
  }
  return out;
}

bool isNameOf(const std::string& name, const fs::path& file) {
  for (int folders = 0; folders <= kMostFolders; ++folders)
    if (nameWithFolders(file, folders) == name) return true;
  return false;
}

// A recording keeps the name that it has in the folder; that of another one which is still there is not taken from it.
std::set<std::string> keepNames(std::vector<PlannedInput>& inputs, const fs::path& folder) {
  std::set<std::string> taken;
  for (const auto& input : inputs)
    if (!input.simulate.empty()) taken.insert(input.input.name);
  const auto earlier = earlierRecordings(folder);
  for (auto& input : inputs)
    for (const auto& [name, file] : earlier)
      if (input.simulate.empty() && input.input.name.empty() && file == input.input.path && isNameOf(name, file) &&
          taken.insert(name).second)
        input.input.name = name;
  std::error_code none;
  for (const auto& [name, file] : earlier)
    if (isNameOf(name, file) && fs::exists(file, none)) taken.insert(name);
  return taken;
}

// Recordings of one name get those of their folders in front, as many as it takes; a number where those are the same, too.
void nameRecordings(std::vector<PlannedInput>& inputs, std::set<std::string> taken) {
  for (int folders = 0;; ++folders) {
    std::map<std::string, int> counts;
    const auto nameOf = [&](const PlannedInput& input) { return nameWithFolders(input.input.path, folders); };
    bool all_named = true;
    for (const auto& input : inputs) {
      if (!input.simulate.empty()) continue;
      ++counts[nameOf(input)];
      all_named = all_named && !input.input.name.empty();
    }
    if (all_named) return;
    for (auto& input : inputs) {
      if (!input.simulate.empty() || !input.input.name.empty()) continue;
      const std::string name = nameOf(input);
      if (counts[name] == 1 && !taken.contains(name)) input.input.name = name;
      if (folders > kMostFolders) {
        input.input.name = numbered(name, taken);
        taken.insert(input.input.name);
      }
    }
    for (const auto& input : inputs) taken.insert(input.input.name);
  }
}

PlannedInput simulatedInput(const InputEntry& entry, std::int64_t seed, const fs::path& folder) {
  const SimulatedInputs& made = *entry.simulated;
  PlannedInput out;
  const bool flat = made.world.empty();
  std::string kind = flat ? "flat" : plainName(made.world.stem().string());
  if (made.handheld) kind += "_handheld";
  if (made.rooms > 0) kind += "_" + std::to_string(made.rooms) + "rooms";
  if (!made.meshes.empty()) kind += "_" + plainName(made.meshes.filename().string());
  out.input.name = kind + (flat ? "_" : "_s") + std::to_string(seed);
  out.input.group = entry.group.empty() ? kind : entry.group;
  out.input.seed = seed;
  out.input.path = (folder / "inputs" / out.input.name).string();
  out.simulate = flat ? std::vector<std::string>{"--flat", std::to_string(seed)}
                      : std::vector<std::string>{made.world.string(), "--seed", std::to_string(seed)};
  if (made.handheld) out.simulate.push_back("--handheld");
  if (made.rooms > 0) out.simulate.insert(out.simulate.end(), {"--rooms", std::to_string(made.rooms)});
  if (!made.meshes.empty()) out.simulate.insert(out.simulate.end(), {"--meshes", made.meshes.string()});
  out.search_truth = entry.search_truth;
  return out;
}

PlannedInput recordedInput(const InputEntry& entry, const fs::path& file) {
  PlannedInput out;
  out.input.path = fs::absolute(file).lexically_normal().string();
  const std::string folder = fs::path(out.input.path).parent_path().filename().string();
  out.input.group = entry.group.empty() ? plainName(folder) : entry.group;
  out.search_truth = entry.search_truth;
  out.truth = namedTruth(entry, out.input.path);
  return out;
}

std::vector<PlannedInput> inputsOfEntry(const InputEntry& entry, const fs::path& folder) {
  std::vector<PlannedInput> out;
  if (entry.simulated)
    for (const auto seed : entry.simulated->seeds) out.push_back(simulatedInput(entry, seed, folder));
  for (const auto& pattern : entry.patterns)
    for (const auto& file : filesOf(pattern, entry.place)) out.push_back(recordedInput(entry, file));
  return out;
}

}  // namespace

BatchPlan planBatch(const JobFile& jobs, const fs::path& folder) {
  BatchPlan plan{{}, jobs.variants, {}, jobs};
  std::map<std::string, std::string> places;  // of paths
  for (const auto& entry : jobs.inputs)
    for (auto& input : inputsOfEntry(entry, folder)) {
      const auto [place, added] = places.emplace(input.input.path, entry.place);
      if (added)
        plan.inputs.push_back(std::move(input));
      else if (!input.simulate.empty() ||
               (jobs.inputs.size() > 1 && place->second != entry.place && !input.truth.empty()))
        throw ConfigError(entry.place + ": " + input.input.path + " is an input already (" + place->second +
                          ")");
    }
  nameRecordings(plan.inputs, keepNames(plan.inputs, folder));
  for (std::size_t i = 0; i < plan.inputs.size(); ++i)
    for (std::size_t v = 0; v < plan.variants.size(); ++v)
      plan.runs.push_back({plan.inputs[i].input.name + "--" + plan.variants[v].name, i, v, {}, {}});
  return plan;
}

}  // namespace roomgraph
