// SPDX-License-Identifier: BSD-3-Clause
// Comparison of neighbouring records by a hash of their content.
#include "repetition.h"

#include <functional>

namespace roomgraph {

void Repetition::add(double t, std::string_view content) {
  const std::size_t hash = std::hash<std::string_view>()(content);
  if (current_.records == 0 || hash != hash_) current_ = {0, t, 0};
  hash_ = hash;
  ++current_.records;
  current_.seconds = t - current_.from;
  if (longest_.records == 0 || current_.seconds > longest_.seconds) longest_ = current_;
}

}  // namespace roomgraph
