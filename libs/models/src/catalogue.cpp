// SPDX-License-Identifier: BSD-3-Clause
// Reading and checking of the catalogue's JSON; look-up by name.
#include "roomgraph/models/catalogue.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "roomgraph/core/checksum.h"
#include "roomgraph/core/json_integer.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

using Json = nlohmann::json;
using LabelLists = std::map<std::string, std::vector<std::string>>;

// Names become names of files and folders, and parts of addresses.
void requireName(const std::string& name) {
  const bool plain =
      !name.empty() && name.front() != '.' &&
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_+.") ==
          std::string::npos;
  if (!plain) throw ConfigError("'" + name + "' is no plain name of a file or folder");
}

void requireDigits(const std::string& sha256) {
  if (sha256.size() != 64 || sha256.find_first_not_of("0123456789abcdef") != std::string::npos)
    throw ConfigError("sha256 '" + sha256 + "' is not 64 hexadecimal digits in lower case");
}

KnownFile fileFrom(const Json& json, const LabelLists& labels) {
  KnownFile file;
  file.name = json.at("name").get<std::string>();
  requireName(file.name);
  file.bytes = integerOf<std::uint64_t>(json.at("bytes"));
  file.sha256 = json.at("sha256").get<std::string>();
  requireDigits(file.sha256);
  file.url = json.value("url", "");
  if (!json.contains("labels")) return file;
  for (const auto& label : labels.at(json.at("labels").get<std::string>())) file.content += label + "\n";
  if (sha256Of(file.content) != file.sha256 || file.content.size() != file.bytes)
    throw ConfigError(file.name + ": size or sha256 is not that of the list of labels");
  return file;
}

KnownNetwork networkFrom(const Json& json, const LabelLists& labels) {
  KnownNetwork out;
  out.name = json.at("name").get<std::string>();
  requireName(out.name);
  out.role = json.at("role").get<std::string>();
  out.author = json.value("author", "");
  out.licence = json.value("licence", "");
  out.project = json.value("project", "");
  out.note = json.value("note", "");
  out.subfolder = json.value("subfolder", out.name);
  requireName(out.subfolder);
  out.finds = json.value("finds", std::vector<std::string>());
  if (const auto figures = json.find("measured"); figures != json.end())
    out.measured = {figures->at("forward_ms").get<double>(), figures->at("recall").get<double>(),
                    figures->at("precision").get<double>(), figures->at("on").get<std::string>()};
  std::set<std::string> names;
  for (const Json& file : json.at("files")) {
    out.files.push_back(fileFrom(file, labels));
    if (!names.insert(out.files.back().name).second)
      throw ConfigError("two files are named " + out.files.back().name);
  }
  if (out.files.empty()) throw ConfigError("it has no files");
  return out;
}

}  // namespace

bool KnownNetwork::published() const {
  return std::all_of(files.begin(), files.end(),
                     [](const KnownFile& file) { return !file.url.empty() || !file.content.empty(); });
}

std::uint64_t KnownNetwork::bytes() const {
  std::uint64_t sum = 0;
  for (const auto& file : files) sum += file.bytes;
  return sum;
}

NetworkCatalogue NetworkCatalogue::fromFile(const std::filesystem::path& file) {
  return fromText(readTextFile(file), file.string());
}

NetworkCatalogue NetworkCatalogue::fromText(const std::string& json, const std::string& name) {
  const Json root = parseJson<Json, ConfigError>(json, name);
  NetworkCatalogue catalogue;
  std::string place = name;
  std::set<std::string> names;
  try {
    const auto labels = root.value("label_lists", LabelLists());
    for (const Json& item : root.at("networks")) {
      place = name + ": network " + std::to_string(names.size() + 1);
      catalogue.networks_.push_back(networkFrom(item, labels));
      if (!names.insert(catalogue.networks_.back().name).second)
        throw ConfigError("the name " + catalogue.networks_.back().name + " is taken");
    }
  } catch (const Error& error) {
    throw ConfigError(place + ": " + error.what());
  } catch (const std::out_of_range&) {
    throw ConfigError(place + ": names a list of labels that is not there");
  } catch (const Json::exception& error) {
    throw ConfigError(place + ": " + firstLine(error));
  }
  return catalogue;
}

const KnownNetwork& NetworkCatalogue::network(const std::string& name) const {
  std::vector<std::string> known;
  for (const auto& network : networks_) {
    if (network.name == name) return network;
    known.push_back(network.name);
  }
  throw ConfigError("unknown network '" + name + "'" + didYouMean(name, known) + "; known: " + join(known));
}

}  // namespace roomgraph
