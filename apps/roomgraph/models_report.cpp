// SPDX-License-Identifier: BSD-3-Clause
// Formatting of the catalogue of networks.
#include "models_report.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "roomgraph/core/suggest.h"
#include "roomgraph/models/model_folder.h"

namespace roomgraph {
namespace {

using nlohmann::ordered_json;

template <class... Values>
std::string columns(const char* pattern, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

double megabytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) / 1e6;
}

std::string stateOf(const KnownNetwork& network, const std::filesystem::path& models) {
  if (isInstalled(network, models)) return networkFile(network, models).string();
  if (isBegun(network, models)) return "not complete";
  return network.published() ? "no" : "no (needs --from)";
}

}  // namespace

std::string networkTable(const NetworkCatalogue& catalogue, const std::filesystem::path& models) {
  std::size_t width = 7;
  for (const auto& network : catalogue.networks()) width = std::max(width, network.name.size());
  const int name_width = static_cast<int>(width);
  std::string text = columns("%-*s  %5s  %-19s  %5s  %6s  %9s  %s\n", name_width, "network", "MB", "finds",
                             "ms", "recall", "precision", "installed");
  for (const auto& network : catalogue.networks()) {
    const auto& measured = network.measured;
    text += columns("%-*s  %5.1f  %-19s  %5.0f  %6.3f  %9.3f  ", name_width, network.name.c_str(),
                    megabytes(network.bytes()), join(network.finds).c_str(), measured.forward_ms,
                    measured.recall, measured.precision) +
            stateOf(network, models) + "\n";
  }
  return text;
}

std::string describeNetwork(const KnownNetwork& network, const std::filesystem::path& models) {
  const auto& measured = network.measured;
  std::string text = network.name + "\n";
  text += "  finds      " + join(network.finds) + "\n";
  text += "  author     " + network.author + ", " + network.project + "\n";
  text += "  licence    " + network.licence + "\n";
  if (!network.note.empty()) text += "  note       " + network.note + "\n";
  text += columns("  measured   %.0f ms an image; recall %.3f, precision %.3f: ", measured.forward_ms,
                  measured.recall, measured.precision) +
          measured.on + "\n";
  for (const auto& file : network.files) {
    text += "  file       " + file.name +
            columns(", %llu bytes", static_cast<unsigned long long>(file.bytes)) + "\n";
    text += "             SHA-256 " + file.sha256 + "\n";
    if (!file.url.empty()) text += "             " + file.url + "\n";
  }
  return text + "  installed  " + stateOf(network, models) + "\n";
}

std::string networksJson(const NetworkCatalogue& catalogue, const std::filesystem::path& models) {
  ordered_json out{{"models", models.string()}, {"networks", ordered_json::array()}};
  for (const auto& network : catalogue.networks()) {
    const bool installed = isInstalled(network, models);
    ordered_json files = ordered_json::array();
    for (const auto& file : network.files) {
      files.push_back({{"name", file.name}, {"bytes", file.bytes}, {"sha256", file.sha256}});
      if (!file.url.empty()) files.back()["url"] = file.url;
    }
    out["networks"].push_back({{"name", network.name},
                               {"role", network.role},
                               {"finds", network.finds},
                               {"author", network.author},
                               {"licence", network.licence},
                               {"project", network.project},
                               {"note", network.note},
                               {"bytes", network.bytes()},
                               {"forward_ms", network.measured.forward_ms},
                               {"recall", network.measured.recall},
                               {"precision", network.measured.precision},
                               {"measured_on", network.measured.on},
                               {"published", network.published()},
                               {"installed", installed},
                               {"path", installed ? networkFile(network, models).string() : ""},
                               {"files", files}});
  }
  return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace roomgraph
