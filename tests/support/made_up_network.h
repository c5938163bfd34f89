// SPDX-License-Identifier: BSD-3-Clause
// Networks made up for tests, and the catalogue that knows them.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "roomgraph/core/checksum.h"
#include "roomgraph/models/catalogue.h"

namespace roomgraph::test {

/// A network whose files have any content.
struct MadeUpNetwork {
  std::string name, role = "objects", subfolder = "collection";
  std::vector<std::pair<std::string, std::string>> files;  ///< name and content, the one to run first
  std::string published = "";                              ///< address of the folder with the files
};

inline nlohmann::json catalogueEntry(const MadeUpNetwork& network) {
  nlohmann::json entry{
      {"name", network.name},
      {"role", network.role},
      {"subfolder", network.subfolder},
      {"author", "Somebody"},
      {"licence", "BSD-3-Clause"},
      {"finds", {"chair"}},
      {"measured", {{"forward_ms", 5}, {"recall", .5}, {"precision", .25}, {"on", "nothing"}}},
      {"files", nlohmann::json::array()}};
  for (const auto& [name, content] : network.files) {
    entry["files"].push_back({{"name", name}, {"bytes", content.size()}, {"sha256", sha256Of(content)}});
    if (!network.published.empty()) entry["files"].back()["url"] = network.published + "/" + name;
  }
  return entry;
}

inline std::string catalogueText(const std::vector<MadeUpNetwork>& networks) {
  nlohmann::json out{{"networks", nlohmann::json::array()}};
  for (const auto& network : networks) out["networks"].push_back(catalogueEntry(network));
  return out.dump(1);
}

inline KnownNetwork known(const MadeUpNetwork& network) {
  return NetworkCatalogue::fromText(catalogueText({network})).networks().front();
}

/// So many bytes without a pattern.
inline std::string noise(std::size_t bytes) {
  std::string out;
  for (std::uint32_t state = 1; out.size() < bytes; state = 1664525u * state + 1013904223u)
    out += static_cast<char>(state >> 24);
  return out;
}

}  // namespace roomgraph::test
