// SPDX-License-Identifier: BSD-3-Clause
// Look at recording and model folder, and a second set-up with what was found there.
#include "installed_networks.h"

#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/rawlog_peek.h"
#include "roomgraph/models/model_folder.h"
#include "shared_files.h"

namespace roomgraph {
namespace {

std::vector<KnownNetwork> installedIn(const std::filesystem::path& folder, const ModelSource& source) {
  std::error_code unreadable;
  if (folder.empty() || !std::filesystem::is_directory(folder, unreadable)) {
    if (source.models.empty()) return {};
    throw ConfigError("--models " + source.models + ": no such folder");
  }
  return networksToRun(NetworkCatalogue::fromFile(catalogueFileOf(source.catalogue)), folder);
}

// Before the recording is opened: what a configuration cannot do does not depend on it.
void requireMotion(const Options& run) {
  if (!run.tracking.enabled && !run.lidar.enabled && !run.odometry.enabled)
    throw ConfigError("every source of motion is switched off: [tracking], [lidar] and [odometry] enabled");
}

/// The network that comes with the program; empty: this copy of the program lacks it.
std::filesystem::path shippedNetwork() {
  try {
    return sharedFile("models/room_detector/room_detector.onnx");
  } catch (const ConfigError&) {
    return {};
  }
}

}  // namespace

RunSetup makeRunSetup(Configuration& configuration, const std::filesystem::path& rawlog,
                      const ModelSource& source) {
  RunSetup out{makeSetup(configuration.config, configuration.objects_file), {}, modelFolder(source.models)};
  requireMotion(out.setup->options);
  const auto networks = installedIn(out.folder, source);
  const auto& detector = out.setup->stages.detector;
  const bool automatic = out.setup->options.detection.detector == "auto";
  if (!automatic || !detector || !detector->idle()) return out;
  const RawlogPeek peek = peekRawlog(rawlog);
  if (peek.detections || !peek.frames) return out;
  std::vector<std::string> files;
  if (const auto shipped = shippedNetwork(); networks.empty() && !shipped.empty()) {
    files.push_back(shipped.string());
    out.networks.push_back(shipped.stem().string());
    out.folder = shipped.parent_path();
  }
  for (const auto& network : networks) {
    files.push_back(networkFile(network, out.folder).string());
    out.networks.push_back(network.name);
  }
  if (files.empty()) return out;
  configuration.config.override("detection.models=" + formatParameter(files));
  out.setup = makeSetup(configuration.config, configuration.objects_file);
  return out;
}

}  // namespace roomgraph
