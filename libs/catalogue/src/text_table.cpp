// SPDX-License-Identifier: BSD-3-Clause
// Alignment, CSV, and the table of all runs with all figures.
#include "roomgraph/catalogue/text_table.h"

#include <algorithm>
#include <cstdio>
#include <unordered_map>

namespace roomgraph {
namespace {

// Characters, not bytes, of UTF-8.
std::size_t widthOf(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string blanks(width - std::min(width, widthOf(text)), ' ');
  return right ? blanks + text : text + blanks;
}

std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

std::string csvLine(const std::vector<std::string>& cells) {
  std::string line;
  for (const auto& cell : cells) line += (&cell == &cells.front() ? "" : ",") + csvCell(cell);
  return line + "\n";
}

// Shortest text that reads back as the same number.
std::string exactText(double value) {
  char text[40];
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}

}  // namespace

std::string alignedText(const TextTable& table) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    widths.push_back(widthOf(table.columns[c]));
    for (const auto& row : table.rows) widths[c] = std::max(widths[c], widthOf(row[c]));
  }
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t c = 0; c < cells.size(); ++c)
      text += (c ? "  " : "") + padded(cells[c], widths[c], c < table.numeric.size() && table.numeric[c]);
    text.erase(text.find_last_not_of(' ') + 1);
    return text + "\n";
  };
  std::vector<std::string> rule;
  for (const std::size_t width : widths) rule.emplace_back(width, '-');
  std::string text = line(table.columns) + line(rule);
  for (const auto& row : table.rows) text += line(row);
  return text;
}

std::string csvText(const TextTable& table) {
  std::string text = csvLine(table.columns);
  for (const auto& row : table.rows) text += csvLine(row);
  return text;
}

TextTable wideTable(const Catalogue& catalogue) {
  TextTable table{{"run", "input", "input_group", "seed", "variant", "status", "reason", "revision", "wall_s",
                   "cpu_s", "peak_memory_mb"},
                  {},
                  {}};
  const std::size_t fixed = table.columns.size();
  const auto names = catalogue.figureNames();
  table.columns.insert(table.columns.end(), names.begin(), names.end());
  std::unordered_map<std::int64_t, std::size_t> places;
  for (const auto& line : catalogue.runs()) {
    places.emplace(line.id, table.rows.size());
    table.rows.push_back({line.name, line.input, line.group, line.seed ? std::to_string(*line.seed) : "",
                          line.variant, line.status, line.reason, line.revision, exactText(line.wall_s),
                          exactText(line.cpu_s), exactText(line.peak_memory_mb)});
    table.rows.back().resize(table.columns.size());
  }
  for (std::size_t i = 0; i < names.size(); ++i)
    for (const auto& [run, value] : catalogue.figure(names[i]))
      table.rows[places.at(run)][fixed + i] = exactText(value);
  return table;
}

}  // namespace roomgraph
