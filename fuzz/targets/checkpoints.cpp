// SPDX-License-Identifier: BSD-3-Clause
// Checkpoints of runs: the journal, and what its records hold.
#include "../target.h"
#include "detection_bytes.h"
#include "roomgraph/core/result_store.h"
#include "view_bytes.h"

namespace roomgraph::fuzz {
namespace {

ROOMGRAPH_FUZZ_TARGET(journal) {
  JournalledResults results(scratchFile("results.journal", bytes), "key", 1);
  while (results.recall("boxes", 1000)) continue;
  results.keep("boxes", 1000, "more");
}

ROOMGRAPH_FUZZ_TARGET(journalled_boxes) {
  decodedResult("boxes", 1000, std::string(bytes), detectionsFrom);
}

ROOMGRAPH_FUZZ_TARGET(journalled_view) {
  decodedResult("view", 1000, std::string(bytes), tracking::locatedView);
}

}  // namespace
}  // namespace roomgraph::fuzz
