// SPDX-License-Identifier: BSD-3-Clause
// Test for forgiven confusions of class `other`.
#include "roomgraph/evaluation/forgiven_kinds.h"

namespace roomgraph {

bool isForgiven(const ForgivenKinds& kinds, const std::string& taken_for, const std::string& true_class,
                const std::string& true_kind) {
  const auto entry = kinds.find(taken_for);
  return true_class == "other" && entry != kinds.end() && true_kind.find(entry->second) != std::string::npos;
}

}  // namespace roomgraph
