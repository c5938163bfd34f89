// SPDX-License-Identifier: BSD-3-Clause
// INI parser: sections, comments, quotes, duplicate keys.
#include "roomgraph/core/ini_text.h"

#include <map>
#include <sstream>

#include "quoted_text.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/core/trim.h"

namespace roomgraph {
namespace {

std::string withoutComment(const std::string& line) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  const auto equals = line.find('=');
  const auto value = equals == std::string::npos ? equals : line.find_first_not_of(" \t", equals + 1);
  bool begins_item = false;  // of a list, or the value: where quotes may open
  for (std::size_t i = 0; i < line.size(); ++i) {
    const auto end = begins_item && line[i] == '"' ? endOfQuoted(line, i) : std::string::npos;
    if (end == line.size()) break;
    if (end != std::string::npos) i = end;
    if (!blank(line[i])) begins_item = i == equals || line[i] == ',';
    const bool marker = line[i] == '#' || line[i] == ';';
    if (!marker || (i > 0 && !blank(line[i - 1]))) continue;
    // "color = #e6862a": a marker with text attached to it, first after the equals sign, belongs to the
    // value.
    const bool begins_value = i == value && i + 1 < line.size() && !blank(line[i + 1]);
    if (!begins_value) return line.substr(0, i);
  }
  return line;
}

}  // namespace

std::vector<IniEntry> parseIni(const std::string& text, const std::string& name) {
  std::vector<IniEntry> entries;
  std::map<std::pair<std::string, std::string>, std::string> seen;
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // put there by editors on Windows
  std::istringstream stream(text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text);
  std::string section;
  int number = 0;
  for (std::string raw; std::getline(stream, raw);) {
    const std::string place = name + ":" + std::to_string(++number);
    const std::string line = trim(withoutComment(raw));
    if (line.empty()) continue;
    if (line.front() == '[' && line.back() == ']') {
      section = trim(line.substr(1, line.size() - 2));
      continue;
    }
    const auto equals = line.find('=');
    if (equals == std::string::npos || equals == 0)
      throw ConfigError(place + ": expected '[section]' or 'key = value', got '" + line + "'");
    IniEntry entry{section, trim(line.substr(0, equals)), trim(line.substr(equals + 1)), place};
    const auto [first, inserted] = seen.try_emplace({section, entry.key}, place);
    if (!inserted)
      throw ConfigError(place + ": [" + section + "] " + entry.key + " is set twice, first at " +
                        first->second);
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::vector<IniEntry> parseIniFile(const std::filesystem::path& file) {
  auto entries = parseIni(readTextFile(file), file.string());
  for (auto& entry : entries) entry.folder = std::filesystem::absolute(file).parent_path();
  return entries;
}

}  // namespace roomgraph
