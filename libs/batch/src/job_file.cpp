// SPDX-License-Identifier: BSD-3-Clause
// The keys of a job file.
#include "roomgraph/batch/job_file.h"

#include <cmath>
#include <set>
#include <sstream>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"
#include "yaml_place.h"

namespace roomgraph {

const std::vector<std::string> kTruthKinds{"trajectory", "camera_trajectory", "objects", "boxes",
                                           "map",        "relations"};

namespace {

namespace fs = std::filesystem;

constexpr const char* kNoneWord = "none";

std::string inFolder(const fs::path& folder, const std::string& name) {
  return name.empty() ? name : (folder / name).lexically_normal().string();
}

SimulatedInputs simulatedOf(const YamlPlace& yaml, const fs::path& folder) {
  SimulatedInputs out;
  bool flats = false;
  for (const auto& [key, value] : yaml.entries({"world", "flats", "seeds", "rooms", "handheld", "meshes"})) {
    const auto numbers = [&v = value] {
      std::string all;
      for (const auto& part : v.texts()) all += (all.empty() ? "" : ",") + part;
      try {
        return numbersOfRanges(all);
      } catch (const std::invalid_argument& error) {
        v.fail(error.what());
      }
    };
    if (key == "world") out.world = inFolder(folder, value.text());
    if (key == "rooms") out.rooms = value.wholeNumber();
    if (key == "meshes") out.meshes = inFolder(folder, value.text());
    if (key == "handheld") out.handheld = value.yesOrNo();
    if (key == "seeds" || key == "flats") out.seeds = numbers();
    flats |= key == "flats";
  }
  if (out.world.empty() != flats) yaml.fail("needs either a world with seeds, or flats");
  if (out.seeds.empty()) out.seeds = {1};
  if (!out.world.empty() && (out.handheld || out.rooms > 0 || !out.meshes.empty()))
    yaml.fail("rooms, handheld and meshes are of flats, not of a world");
  if (!out.meshes.empty() && !fs::is_directory(out.meshes))
    yaml.fail("meshes " + out.meshes.string() + ": no such folder");
  if (!out.world.empty() && !fs::is_regular_file(out.world))
    yaml.fail("world " + out.world.string() + ": no such file");
  return out;
}

void readTruth(const YamlPlace& yaml, const fs::path& folder, InputEntry& entry) {
  entry.search_truth = false;
  if (yaml.isMap()) {
    for (const auto& [kind, pattern] : yaml.entries(kTruthKinds)) {
      const std::string name = pattern.text();
      entry.truth[kind] = name.starts_with("{folder}") ? name : inFolder(folder, name);
    }
    return;
  }
  const std::string name = yaml.text();
  if (name == kNoneWord) return;
  entry.truth["folder"] = name.starts_with("{folder}") ? name : inFolder(folder, name);
}

InputEntry inputOf(const YamlPlace& yaml, const fs::path& folder) {
  InputEntry entry;
  entry.place = yaml.place();
  if (yaml.isText()) {
    entry.patterns = {inFolder(folder, yaml.text())};
    return entry;
  }
  for (const auto& [key, value] : yaml.entries({"files", "simulate", "truth", "group"})) {
    if (key == "files")
      for (const auto& pattern : value.texts()) entry.patterns.push_back(inFolder(folder, pattern));
    if (key == "simulate") entry.simulated = simulatedOf(value, folder);
    if (key == "group") entry.group = value.text();
    if (key == "truth") readTruth(value, folder, entry);
  }
  if (entry.patterns.empty() != entry.simulated.has_value()) yaml.fail("needs either files or simulate");
  if (entry.simulated && (!entry.truth.empty()))
    yaml.fail("the truth of what is simulated is known; only 'truth: none' makes sense");
  return entry;
}

BatchVariant variantOf(const YamlPlace& yaml, const fs::path& folder) {
  BatchVariant out;
  out.name.clear();
  for (const auto& [key, value] : yaml.entries({"name", "config", "set", "pose"})) {
    if (key == "name") out.name = value.text();
    if (key == "config") out.config = inFolder(folder, value.text());
    if (key == "set") out.overrides = value.texts();
    if (key == "pose") out.poses = value.texts();
    if (key == "config" && !fs::is_regular_file(out.config))
      value.fail(out.config.string() + ": no such file");
  }
  const bool plain = !out.name.empty() && std::all_of(out.name.begin(), out.name.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == '+';
  });
  if (!plain || out.name.starts_with(".")) yaml.fail("needs a name of letters, digits, '_', '-', '.', '+'");
  return out;
}

std::vector<BatchVariant> variantsOf(const YamlPlace& yaml, const fs::path& folder) {
  std::vector<BatchVariant> out;
  std::set<std::string> names;
  for (const auto& item : yaml.items()) {
    out.push_back(variantOf(item, folder));
    if (!names.insert(out.back().name).second) item.fail("there are two variants '" + out.back().name + "'");
  }
  if (out.empty()) yaml.fail("is empty");
  return out;
}

BatchLimits limitsOf(const YamlPlace& yaml) {
  BatchLimits out;
  for (const auto& [key, value] : yaml.entries({"jobs", "threads", "memory", "time", "retries"})) {
    if (key == "jobs") out.jobs = value.wholeNumber();
    if (key == "threads") out.threads = value.wholeNumber();
    if (key == "retries") out.retries = value.wholeNumber();
    if (key == "memory") out.memory_mb = value.as(megabytesOf);
    if (key == "time") out.time_s = value.as(secondsOf);
    if (key == "threads" && out.threads < 1) value.fail("is to be 1 or more");
  }
  return out;
}

SlurmSettings slurmOf(const YamlPlace& yaml) {
  SlurmSettings out;
  for (const auto& [key, value] :
       yaml.entries({"partition", "time", "memory", "cpus", "options", "setup", "poll", "patience"})) {
    if (key == "partition") out.partition = value.text();
    if (key == "time") out.time_s = value.as(secondsOf);
    if (key == "memory") out.memory_mb = value.as(megabytesOf);
    if (key == "cpus") out.cpus = value.wholeNumber();
    if (key == "options") out.options = value.texts();
    if (key == "setup") out.setup = value.texts();
    if (key == "poll") out.poll_s = value.as(secondsOf);
    if (key == "patience") out.patience_s = value.as(secondsOf);
    for (const auto& option : out.options)
      if (!option.starts_with("-") || option.find('\n') != std::string::npos)
        value.fail("'" + option + "' is no option; write it like --account=lab");
  }
  return out;
}

std::vector<std::string> wordsOf(const YamlPlace& yaml) {
  std::vector<std::string> out;
  for (const auto& text : yaml.texts()) {
    std::istringstream in(text);
    for (std::string word; in >> word;) out.push_back(word);
  }
  return out;
}

}  // namespace

JobFile readJobFile(const fs::path& file) {
  const YamlPlace yaml = readYaml(file.string());
  const fs::path folder = fs::absolute(file).parent_path();
  JobFile out;
  for (const auto& [key, value] :
       yaml.entries({"inputs", "variants", "limits", "split", "overlap", "slurm", "keep", "evaluation"})) {
    if (key == "inputs")
      for (const auto& item : value.items()) out.inputs.push_back(inputOf(item, folder));
    if (key == "variants") out.variants = variantsOf(value, folder);
    if (key == "limits") out.limits = limitsOf(value);
    if (key == "split") out.split.length_s = value.as(secondsOf);
    if (key == "overlap") out.split.overlap_s = value.as(secondsOf);
    if (key == "slurm") out.slurm = slurmOf(value);
    if (key == "keep") out.keep = value.as(keepFromText);
    if (key == "evaluation")
      for (const auto& [kind, words] :
           value.entries({"trajectory", "live", "relations", "objects", "objects_live", "detections", "map"}))
        out.evaluation[kind] = wordsOf(words);
  }
  if (out.inputs.empty()) yaml.fail("has no inputs");
  return out;
}

void requireSensibleSplit(const BatchSplit& split) {
  if (split.length_s > 0 && split.length_s < 3 * split.overlap_s)
    throw ConfigError("pieces of " + std::to_string(std::lround(split.length_s)) + " s that overlap by " +
                      std::to_string(std::lround(split.overlap_s)) +
                      " s: they have to be three times as long, at least (--split, --overlap)");
}

JobFile jobsOfRecordings(const std::vector<std::string>& patterns) {
  JobFile out;
  for (const auto& pattern : patterns) {
    InputEntry entry;
    entry.patterns = {fs::absolute(pattern).lexically_normal().string()};
    entry.place = pattern;
    out.inputs.push_back(entry);
  }
  return out;
}

}  // namespace roomgraph
