// SPDX-License-Identifier: BSD-3-Clause
// Reading of --config and --set; default config.ini and lookup of objects.ini.
#include "configuration.h"

#include "roomgraph/core/errors.h"
#include "shared_files.h"

namespace roomgraph {

Configuration readConfiguration(const std::string& file, const std::vector<std::string>& overrides) {
  Configuration out;
  out.file = file.empty() ? sharedFile("config.ini") : std::filesystem::path(file);
  try {
    out.config = Config::fromFile(out.file);
  } catch (const InputError& error) {
    throw ConfigError(std::string("--config ") + error.what());
  }
  for (const auto& assignment : overrides) out.config.override(assignment);
  out.objects_file = out.file.parent_path() / "objects.ini";
  if (!std::filesystem::exists(out.objects_file)) out.objects_file = sharedFile("objects.ini");
  return out;
}

}  // namespace roomgraph
