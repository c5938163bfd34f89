// SPDX-License-Identifier: BSD-3-Clause
// Checksums of files, reckoned once and remembered in the catalogue.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "roomgraph/catalogue/catalogue.h"

namespace roomgraph {

/// SHA-256 of files. A file that has the size and time of an earlier look is not read again.
class FileHashes {
 public:
  /// Both outlive it. `known`: where earlier looks are remembered, `memory`: where new ones are put; nothing:
  /// nowhere.
  FileHashes(const Catalogue* known, Catalogue* memory) : catalogue_(known), memory_(memory) {}
  /// Throws InputError: cannot be read.
  std::string of(const std::filesystem::path& file);
  /// Whether it is known without reading the file.
  bool knows(const std::filesystem::path& file);
  /// What somebody else has reckoned.
  void remember(const std::filesystem::path& file, const std::string& sha256);
  /// Of several files together.
  std::string of(const std::vector<std::filesystem::path>& files);
  /// Of a recording; names and sizes of its external images count too.
  std::string ofRecording(const std::filesystem::path& rawlog);

 private:
  const Catalogue* catalogue_;
  Catalogue* memory_;
  std::map<std::string, std::pair<std::string, std::string>> known_;  ///< stamp and hash by path
};

}  // namespace roomgraph
