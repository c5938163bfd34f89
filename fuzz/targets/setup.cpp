// SPDX-License-Identifier: BSD-3-Clause
// Whole configurations, with the parameters of every stage.
#include "roomgraph/pipeline/setup.h"
#include "../target.h"

namespace roomgraph::fuzz {
namespace {

ROOMGRAPH_FUZZ_TARGET(config) {
  // Loading whatever library a configuration names is what plug-ins are for.
  if (bytes.find("plugins") != std::string_view::npos) return;
  makeSetup(Config::fromText(std::string(bytes), "config.ini"), ROOMGRAPH_SOURCE_DIR "/objects.ini");
}

}  // namespace
}  // namespace roomgraph::fuzz
