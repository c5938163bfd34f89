// SPDX-License-Identifier: BSD-3-Clause
// What runs of a variant depend on, for `roomgraph batch`.
#pragma once

#include <map>
#include <optional>

#include "configuration.h"
#include "roomgraph/batch/batch.h"
#include "roomgraph/pipeline/setup.h"

namespace roomgraph {

/// Sets runs up as `roomgraph run` does, once for each variant, and tells what they depend on.
class ProgramInspector : public RunInspector {
 public:
  RunNeeds needsOf(const BatchVariant& variant, const std::filesystem::path& rawlog) override;
  /// Throws ConfigError that names the variant: it is wrong, whatever the recording.
  void check(const BatchVariant& variant);

 private:
  struct Known {
    Configuration configuration;
    RunNeeds needs;
    bool wants_networks = false;  ///< when the recording has images and no boxes
    std::optional<RunNeeds> with_networks;
  };
  Known& known(const BatchVariant& variant);
  std::map<std::string, Known> variants_;
};

/// Configuration, objects and files that a run with this set-up depends on.
RunNeeds runNeedsOf(const Setup& setup);

/// This program and its libraries.
BatchProgram thisProgram();

}  // namespace roomgraph
