// SPDX-License-Identifier: BSD-3-Clause
// Effective configuration, networks and libraries that a run depends on.
#include "batch_inspector.h"

#include <fstream>
#include <set>

#include "installed_networks.h"
#include "program.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/mentioned_files.h"
#include "roomgraph/datasets/rawlog_peek.h"
#include "roomgraph/pipeline/read_options.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

// What is carried between detections is carried again when they are replayed.
const std::set<std::string> kNotOfDetections{"detection.track_boxes", "detection.max_carried_frames"};

// A network has files of its name beside it (weights, description, calibration of its scores), and perhaps its labels.
void addWithCompanions(const fs::path& file, std::set<fs::path>& out) {
  out.insert(file);
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(file.parent_path(), error)) {
    const std::string name = entry.path().filename().string();
    const bool companion = name.starts_with(file.stem().string() + ".") || name == "labels.txt";
    if (companion && entry.is_regular_file(error)) out.insert(entry.path());
  }
}

}  // namespace

RunNeeds runNeedsOf(const Setup& setup) {
  RunNeeds needs;
  needs.objects = setup.objects;
  const Config effective = Config::fromText(setup.effective_config, "effective configuration");
  for (const auto& entry : effective.entries())
    needs.parameters[entry.section + "." + entry.key] = entry.value;
  std::set<fs::path> files;
  std::error_code error;
  for (const auto& file : mentionedFiles(effective))
    if (file.is_absolute() && fs::is_regular_file(file, error)) addWithCompanions(file, files);
  needs.files.assign(files.begin(), files.end());
  const std::string& detector = setup.options.detection.detector;
  const bool networks = setup.stages.detector && !effective.text("detection", "models", "").empty();
  if (!networks || (detector != "auto" && detector != "AutoDetector" && detector != "DnnDetector"))
    return needs;
  for (const auto& [name, value] : needs.parameters)
    if ((name.starts_with("detection.") || name.starts_with("rgbd.") || name.starts_with("pipeline.")) &&
        !kNotOfDetections.contains(name))
      needs.detections += name + "=" + value + "\n";
  return needs;
}

ProgramInspector::Known& ProgramInspector::known(const BatchVariant& variant) {
  const auto place = variants_.find(variant.name);
  if (place != variants_.end()) return place->second;
  Known made;
  made.configuration = readConfiguration(variant.config.string(), variant.overrides);
  for (const auto& pose : variant.poses) placeSensor(made.configuration.config, pose);
  const auto setup = makeSetup(made.configuration.config, made.configuration.objects_file);
  made.needs = runNeedsOf(*setup);
  made.wants_networks =
      setup->options.detection.detector == "auto" && setup->stages.detector && setup->stages.detector->idle();
  return variants_[variant.name] = std::move(made);
}

void ProgramInspector::check(const BatchVariant& variant) {
  try {
    known(variant);
  } catch (const Error& error) {
    throw ConfigError("variant '" + variant.name + "': " + error.what());
  }
}

RunNeeds ProgramInspector::needsOf(const BatchVariant& variant, const fs::path& rawlog) {
  Known& of_variant = known(variant);
  const RawlogPeek peek = peekRawlog(rawlog);  // also finds what cannot be read
  if (!of_variant.wants_networks || peek.detections || !peek.frames) return of_variant.needs;
  if (!of_variant.with_networks) {
    Configuration configuration = of_variant.configuration;
    of_variant.with_networks = runNeedsOf(*makeRunSetup(configuration, rawlog, {}).setup);
  }
  return *of_variant.with_networks;
}

BatchProgram thisProgram() {
  BatchProgram out{fs::read_symlink("/proc/self/exe"), kVersion, kRevision, {}, {}};
  std::set<fs::path> parts{out.file};
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (const auto at = line.find('/');
        at != std::string::npos && line.find("/libroomgraph_", at) != std::string::npos)
      parts.insert(line.substr(at));
  out.parts.assign(parts.begin(), parts.end());
  for (const auto& part : out.parts)
    if (part.filename().string().starts_with("libroomgraph_simulation")) out.simulator.push_back(part);
  return out;
}

}  // namespace roomgraph
