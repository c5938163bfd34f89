// SPDX-License-Identifier: BSD-3-Clause
// All known configuration sections and keys: check for unknown ones, reference page.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/core/config.h"
#include "roomgraph/core/parameters.h"

namespace roomgraph {

/// Every section and key that a configuration may hold, collected from the declarations themselves.
/// A section may be shared by several classes (all implementations of one stage): then a key is known when
/// any of them declares it, so that exchanging a class by name needs no other edit.
class ConfigSchema {
 public:
  struct Key {
    std::string key, type, default_text, doc, unit, allowed;
    std::vector<std::string> owners;  ///< classes that read it; none: every implementation of the section
  };
  struct Section {
    std::string name, doc;
    std::vector<Key> keys;
  };

  /// Adds the declarations of `source` (its current values are the defaults).
  void add(const std::string& section, Configurable& source, const std::string& owner = "");
  void describe(const std::string& section, const std::string& doc);

  /// Throws ConfigError naming the place, and the closest known name, of the first unknown section or key.
  void check(const Config& config) const;

  /// Reference page of all sections and keys in Markdown.
  std::string markdown() const;

  const std::vector<Section>& sections() const { return sections_; }

 private:
  Section& section(const std::string& name);
  std::vector<Section> sections_;
};

}  // namespace roomgraph
