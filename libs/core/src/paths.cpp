// SPDX-License-Identifier: BSD-3-Clause
// Containment of canonical paths.
#include "roomgraph/core/paths.h"

#include <algorithm>

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

// Absolute and without links, as far as it exists, and without a slash at its end.
fs::path real(const fs::path& file) {
  std::error_code error;
  const fs::path out = fs::weakly_canonical(fs::absolute(file), error).lexically_normal();
  return error ? fs::absolute(file).lexically_normal() : out.has_filename() ? out : out.parent_path();
}

}  // namespace

bool isInside(const fs::path& file, const fs::path& folder) {
  if (file.empty()) return false;
  const fs::path inner = real(file), outer = real(folder);
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

}  // namespace roomgraph
