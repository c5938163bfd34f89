// SPDX-License-Identifier: BSD-3-Clause
// Kinds of true objects that may be taken for a class without penalty.
#pragma once

#include <map>
#include <string>

namespace roomgraph {

/// By class: a true object of class `other` whose kind contains the text may be taken for one of the class;
/// that is neither right nor wrong.
using ForgivenKinds = std::map<std::string, std::string>;

/// A chair without wheels may be taken for a swivel chair.
inline ForgivenKinds forgivenChairs() {
  return {{"swivel_chair", "chair"}};
}

/// Whether the true object may be taken for one of class `taken_for`.
bool isForgiven(const ForgivenKinds& kinds, const std::string& taken_for, const std::string& true_class,
                const std::string& true_kind);

}  // namespace roomgraph
