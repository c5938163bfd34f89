// SPDX-License-Identifier: BSD-3-Clause
// Removal of white space around a text.
#pragma once

#include <string>

namespace roomgraph {

/// The text without the blanks (and line ends, which MRPT's trim() leaves) around it.
inline std::string trim(const std::string& text) {
  constexpr const char* kBlanks = " \t\r\n";
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace roomgraph
