// SPDX-License-Identifier: BSD-3-Clause
// The table of configuration sections: what each holds, and what is made from it.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "roomgraph/core/class_registry.h"
#include "roomgraph/pipeline/setup.h"

namespace roomgraph {

/// Reads sections, and collects the parameters as they are used (the effective config).
class SectionReader {
 public:
  explicit SectionReader(const Config& config) : config_(config) {}

  void read(const std::string& section, Configurable& target) {
    config_.read(section, target);
    note(section, target);
  }
  /// The parameters of the target as they are now are the effective ones.
  /// One that is noted already stays: classes in one section share the parameters of the same name.
  void note(const std::string& section, Configurable& target);
  /// INI text of everything noted, in order of the sections' first note.
  std::string text() const;

 private:
  const Config& config_;
  std::vector<std::pair<std::string, std::string>> sections_;
};

/// One section of the configuration.
struct ConfigSection {
  std::string name, doc;
  /// Reads the section's options and makes its stage, if it has one.
  std::function<void(SectionReader&, Setup&)> load;
  /// Declares its options and those of every class that may stand in it.
  std::function<void(ConfigSchema&)> describe;
};

/// All sections but [pipeline], in the order in which they are read and documented.
const std::vector<ConfigSection>& configSections();

}  // namespace roomgraph
