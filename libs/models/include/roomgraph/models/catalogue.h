// SPDX-License-Identifier: BSD-3-Clause
// NetworkCatalogue: the networks that the program knows, with their files, sizes and checksums.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace roomgraph {

/// One file of a known network.
struct KnownFile {
  std::string name;  ///< without folders
  std::uint64_t bytes = 0;
  std::string sha256;   ///< 64 hexadecimal digits in lower case
  std::string url;      ///< where these very bytes are published; empty: nowhere
  std::string content;  ///< of a list of labels, which the catalogue holds itself; empty: the file is fetched
};

/// What was measured with a network.
struct NetworkFigures {
  double forward_ms = 0;  ///< one image, two cores
  double recall = 0, precision = 0;
  std::string on;  ///< which data, which thresholds
};

/// One network of the catalogue.
struct KnownNetwork {
  std::string name;
  std::string role;  ///< networks of one role replace each other ("objects", "doors")
  std::string author, licence, project, note;
  std::string subfolder;           ///< where collections keep its files, besides a folder of its name
  std::vector<std::string> finds;  ///< classes of the object database
  NetworkFigures measured;
  std::vector<KnownFile> files;  ///< first the one that [detection] models names

  /// Whether each of its files is published, or held by the catalogue.
  bool published() const;
  std::uint64_t bytes() const;
};

/// The known networks; of one role the better ones first.
class NetworkCatalogue {
 public:
  /// Reads a catalogue (networks.json). Throws InputError (file) or ConfigError (what is wrong in it).
  static NetworkCatalogue fromFile(const std::filesystem::path& file);
  static NetworkCatalogue fromText(const std::string& json, const std::string& name = "catalogue");

  const std::vector<KnownNetwork>& networks() const { return networks_; }
  /// Throws ConfigError that lists the known names.
  const KnownNetwork& network(const std::string& name) const;

 private:
  std::vector<KnownNetwork> networks_;
};

}  // namespace roomgraph
