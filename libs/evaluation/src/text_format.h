// SPDX-License-Identifier: BSD-3-Clause
// Formatting of table cells and JSON values that may be undefined.
#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

namespace roomgraph {

/// printf into a string; at most 255 characters.
template <class... Args>
std::string format(const char* pattern, Args... args) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, args...);
  return text;
}

/// One cell of a table: "-" for an undefined value.
inline std::string cell(double value, bool defined, const char* pattern) {
  return defined ? format(pattern, value) : "-";
}

/// The same in JSON, with null.
inline nlohmann::ordered_json orNull(double value, bool defined) {
  return defined ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace roomgraph
