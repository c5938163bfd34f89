// SPDX-License-Identifier: BSD-3-Clause
// Quotes, escapes and splitting of comma-separated lists in INI values.
#include "quoted_text.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "roomgraph/core/trim.h"

namespace roomgraph {
namespace {

constexpr const char* kBlanks = " \t\r\n";

bool isBlank(char c) {
  return std::string_view(kBlanks).find(c) != std::string_view::npos;
}

// Whether a comment would begin in the text.
bool holdsMarker(const std::string& text, bool in_list) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '#' && text[i] != ';') continue;
    if (i > 0 ? isBlank(text[i - 1]) : in_list || text.size() == 1 || isBlank(text[1])) return true;
  }
  return false;
}

}  // namespace

std::size_t endOfQuoted(const std::string& text, std::size_t begin) {
  for (std::size_t i = begin + 1; i < text.size(); ++i) {
    if (text[i] == '"') return i + 1;
    if (text[i] == '\\') ++i;
  }
  return std::string::npos;
}

std::string quotedWhenNeeded(const std::string& text, bool in_list) {
  const bool plain = text.find_first_of("\"\n") == std::string::npos && trim(text) == text &&
                     !holdsMarker(text, in_list) &&
                     !(in_list && (text.empty() || text.find(',') != std::string::npos));
  if (plain) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' ? "\\n" : std::string(1, c);
  }
  return out + "\"";
}

std::string unquoted(const std::string& text) {
  if (!text.starts_with('"')) return text;
  if (endOfQuoted(text, 0) != text.size())
    throw std::invalid_argument(
        "a text in double quotes that ends with the second one (\\\" for one inside)");
  std::string out;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    if (text[i] != '\\') {
      out += text[i];
      continue;
    }
    const char c = text[++i];
    if (c != '"' && c != '\\' && c != 'n')
      throw std::invalid_argument("in double quotes only \\\", \\\\ and \\n after a backslash");
    out += c == 'n' ? '\n' : c;
  }
  return out;
}

std::vector<std::string> listItems(const std::string& text) {
  std::vector<std::string> items;
  for (std::size_t begin = 0; begin < text.size();) {
    begin = std::min(text.find_first_not_of(kBlanks, begin), text.size());
    const bool is_quoted = begin < text.size() && text[begin] == '"';
    const auto end = std::min(text.find(',', is_quoted ? endOfQuoted(text, begin) : begin), text.size());
    const std::string item = trim(text.substr(begin, end - begin));
    if (!item.empty()) items.push_back(unquoted(item));
    begin = end + 1;
  }
  return items;
}

}  // namespace roomgraph
