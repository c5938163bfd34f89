// SPDX-License-Identifier: BSD-3-Clause
// Parser of finite numbers separated by white space or commas.
#include "number_table.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

constexpr const char* kSeparators = " \t\r,";

double parseNumber(std::string text, const std::string& place) {
  if (text.size() > 1 && text.front() == '+') text.erase(0, 1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    throw InputError(place + ": '" + text + "' is not a finite number");
  return value;
}

}  // namespace

std::vector<NumberRow> readNumberTable(const std::filesystem::path& file) {
  std::istringstream in(readTextFile(file));
  std::vector<NumberRow> rows;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    NumberRow row{file.string() + ":" + std::to_string(++number), {}};
    std::size_t begin = line.find_first_not_of(kSeparators);
    if (begin == std::string::npos || line[begin] == '#' || line[begin] == '%') continue;
    while (begin != std::string::npos) {
      const std::size_t end = line.find_first_of(kSeparators, begin);
      row.values.push_back(parseNumber(line.substr(begin, end - begin), row.place));
      begin = end == std::string::npos ? end : line.find_first_not_of(kSeparators, end);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace roomgraph
