// SPDX-License-Identifier: BSD-3-Clause
// Text within HTML and XML.
#pragma once

#include <string>

namespace roomgraph {

/// Text as content, or as an attribute within double quotes, of HTML or XML: characters with a meaning there are named, control
/// characters, of which XML may hold few, become spaces.
inline std::string escapedForMarkup(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

}  // namespace roomgraph
