// SPDX-License-Identifier: BSD-3-Clause
// Folders and addresses put together from --from and the catalogue.
#include "source_places.h"

#include <filesystem>

#include "roomgraph/core/errors.h"

namespace roomgraph {

bool isAddress(const std::string& from) {
  return from.find("://") != std::string::npos;
}

std::vector<std::string> placesOf(const KnownNetwork& network, const KnownFile& file,
                                  const std::string& from) {
  if (from.empty()) {
    if (file.url.empty())
      throw ConfigError(network.name + ": " + file.name +
                        " is published nowhere with the bytes of the catalogue; give --from, a folder that "
                        "holds it or the address of one");
    return {file.url};
  }
  std::error_code error;
  if (isAddress(from) && !from.starts_with("http://") && !from.starts_with("https://"))
    throw ConfigError("--from " + from + ": an address begins with http:// or https://");
  if (!isAddress(from) && !std::filesystem::is_directory(from, error))
    throw InputError("--from " + from + ": no such folder");
  const std::string base = from.ends_with("/") ? from : from + "/";
  std::vector<std::string> places{base + file.name, base + network.subfolder + "/" + file.name};
  if (network.subfolder != network.name) places.push_back(base + network.name + "/" + file.name);
  return places;
}

}  // namespace roomgraph
