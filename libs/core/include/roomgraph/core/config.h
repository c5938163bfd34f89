// SPDX-License-Identifier: BSD-3-Clause
// Parsed INI configuration with overrides, read into Configurable objects.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roomgraph/core/ini_text.h"
#include "roomgraph/core/parameters.h"

namespace roomgraph {

/// A parsed configuration: INI entries plus overrides. Values are read into Configurable objects by section.
class Config {
 public:
  Config() = default;
  explicit Config(std::vector<IniEntry> entries) : entries_(std::move(entries)) {}
  /// Throws InputError when the file cannot be read, ConfigError when it is not valid INI.
  static Config fromFile(const std::filesystem::path& file);
  static Config fromText(const std::string& text, const std::string& name = "config");

  /// Applies "section.key=value" as given to --set; relative files are in the working directory. Throws
  /// ConfigError when it does not have that form.
  void override(const std::string& assignment);

  /// Reads every declared parameter that has an entry in `section`; others keep their defaults. Files get
  /// absolute paths. Throws ConfigError with file, section, key, value and what is allowed.
  void read(const std::string& section, Configurable& target) const;

  /// Text of one entry, or `fallback`. Throws ConfigError when its quotes are not closed.
  std::string text(const std::string& section, const std::string& key, const std::string& fallback) const;

  const std::vector<IniEntry>& entries() const { return entries_; }

 private:
  std::vector<IniEntry> entries_;
};

/// The parameters of `source` as they are now, as INI lines "key = value".
std::vector<std::pair<std::string, std::string>> currentValues(Configurable& source);

}  // namespace roomgraph
