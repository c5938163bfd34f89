// SPDX-License-Identifier: BSD-3-Clause
// Spelling suggestions by edit distance, and joining of lists for messages.
#pragma once

#include <string>
#include <vector>

namespace roomgraph {

/// The candidate closest to `word` by edit distance (a missing unit counts as one edit), or empty when none is a likely
/// misspelling.
std::string closestMatch(const std::string& word, const std::vector<std::string>& candidates);

/// " (did you mean 'x'?)" or "".
std::string didYouMean(const std::string& word, const std::vector<std::string>& candidates);

/// "a, b, c".
std::string join(const std::vector<std::string>& items, const std::string& separator = ", ");

}  // namespace roomgraph
