// SPDX-License-Identifier: BSD-3-Clause
// Look-up, sizes and checksums of installed networks.
#include "roomgraph/models/model_folder.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <set>

#include "partial_file.h"
#include "roomgraph/core/checksum.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

// A relative one says nothing, by the XDG base directory specification.
fs::path absoluteFrom(const char* variable) {
  const char* value = std::getenv(variable);
  return value && fs::path(value).is_absolute() ? fs::path(value) : fs::path();
}

std::optional<std::uint64_t> sizeOf(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  const auto bytes = fs::file_size(file, error);
  return error ? std::nullopt : std::optional<std::uint64_t>(bytes);
}

std::string faultOf(const KnownFile& file, const fs::path& place) {
  const auto bytes = sizeOf(place);
  const auto begun = sizeOf(PartialFile::nameFor(place));
  if (!bytes && begun)
    return "is not complete: " + std::to_string(*begun) + " of " + std::to_string(file.bytes) +
           " bytes were fetched";
  if (!bytes) return "is not there";
  if (*bytes != file.bytes)
    return "has " + std::to_string(*bytes) + " bytes instead of " + std::to_string(file.bytes);
  const std::string sum = sha256OfFile(place);
  return sum == file.sha256 ? "" : "has the SHA-256 " + sum + " instead of " + file.sha256;
}

}  // namespace

fs::path modelFolder(const std::string& asked_for) {
  if (!asked_for.empty()) return fs::absolute(asked_for).lexically_normal();
  const fs::path data = absoluteFrom("XDG_DATA_HOME"), home = absoluteFrom("HOME");
  if (!data.empty()) return data / "roomgraph" / "models";
  return home.empty() ? home : home / ".local" / "share" / "roomgraph" / "models";
}

fs::path folderOf(const KnownNetwork& network, const fs::path& models) {
  return models / network.name;
}

fs::path networkFile(const KnownNetwork& network, const fs::path& models) {
  return folderOf(network, models) / network.files.front().name;
}

bool isInstalled(const KnownNetwork& network, const fs::path& models) {
  return !models.empty() &&
         std::all_of(network.files.begin(), network.files.end(), [&](const KnownFile& file) {
           return sizeOf(folderOf(network, models) / file.name) == file.bytes;
         });
}

bool isBegun(const KnownNetwork& network, const fs::path& models) {
  return std::any_of(network.files.begin(), network.files.end(), [&](const KnownFile& file) {
    const fs::path place = folderOf(network, models) / file.name;
    return sizeOf(place) || sizeOf(PartialFile::nameFor(place));
  });
}

std::vector<std::string> faultsOf(const KnownNetwork& network, const fs::path& models) {
  std::vector<std::string> faults;
  for (const auto& file : network.files) {
    const fs::path place = folderOf(network, models) / file.name;
    if (const std::string fault = faultOf(file, place); !fault.empty())
      faults.push_back(place.string() + ": " + fault);
  }
  return faults;
}

std::vector<KnownNetwork> networksToRun(const NetworkCatalogue& catalogue, const fs::path& models) {
  std::vector<KnownNetwork> chosen;
  std::set<std::string> roles;
  for (const auto& network : catalogue.networks())
    if (!roles.contains(network.role) && isInstalled(network, models)) {
      roles.insert(network.role);
      chosen.push_back(network);
    }
  return chosen;
}

}  // namespace roomgraph
