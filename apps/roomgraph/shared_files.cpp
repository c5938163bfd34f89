// SPDX-License-Identifier: BSD-3-Clause
// Search for shipped files relative to the executable.
#include "shared_files.h"

#include "roomgraph/core/errors.h"

namespace roomgraph {

std::filesystem::path sharedFile(const std::string& name) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const auto place = (program / ".." / "share" / "roomgraph").lexically_normal();
  if (std::filesystem::exists(place / name)) return std::filesystem::canonical(place / name);
  throw ConfigError(name + ": not found in " + place.string() + "; name one with --config");
}

std::filesystem::path catalogueFileOf(const std::string& asked_for) {
  return asked_for.empty() ? sharedFile("networks.json") : std::filesystem::path(asked_for);
}

std::filesystem::path objectsFileOf(const std::filesystem::path& run_file, const std::string& asked_for) {
  if (!asked_for.empty()) return asked_for;
  const auto beside = run_file.parent_path() / "objects.ini";
  return std::filesystem::is_regular_file(beside) ? beside : sharedFile("objects.ini");
}

}  // namespace roomgraph
