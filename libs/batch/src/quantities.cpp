// SPDX-License-Identifier: BSD-3-Clause
// Amounts of memory and time, and lists of seeds, as people write them.
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

#include "roomgraph/batch/job_file.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph {
namespace {

constexpr std::int64_t kMostSeeds = 1000000;

// "1.5 GB" with the factor of its unit; a bare number has the factor of "".
double amountOf(const std::string& text, const std::map<std::string, double>& units,
                const std::string& example) {
  std::istringstream in(text);
  double number = 0;
  std::string unit, more;
  const bool read = static_cast<bool>(in >> number);
  in >> unit >> more;
  if (!read || !more.empty() || !units.contains(unit) || !(number >= 0) || !std::isfinite(number))
    throw std::invalid_argument("'" + text + "' is none; write it like " + example);
  return number * units.at(unit);
}

std::int64_t wholeNumber(const std::string& text) {
  std::size_t used = 0;
  std::int64_t number = -1;
  try {
    number = std::stoll(text, &used);
  } catch (const std::exception&) {
  }
  if (number < 0 || text.find_first_not_of(' ', used) != std::string::npos)
    throw std::invalid_argument("'" + text + "' is no number; write it like 1-10 or 1, 2, 5");
  return number;
}

}  // namespace

double megabytesOf(const std::string& text) {
  return amountOf(
      text, {{"", 1}, {"MB", 1}, {"GB", 1000}, {"MiB", 1.048576}, {"GiB", 1073.741824}, {"TB", 1e6}}, "8 GB");
}

double secondsOf(const std::string& text) {
  return amountOf(text, {{"", 1}, {"s", 1}, {"min", 60}, {"h", 3600}, {"d", 86400}}, "30 min");
}

std::vector<std::int64_t> numbersOfRanges(const std::string& text) {
  std::vector<std::int64_t> out;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) {
    const auto dash = part.find('-', 1);
    const std::int64_t first = wholeNumber(part.substr(0, dash));
    const std::int64_t last = dash == std::string::npos ? first : wholeNumber(part.substr(dash + 1));
    if (last < first || last - first > kMostSeeds) throw std::invalid_argument("'" + part + "' is no range");
    for (std::int64_t number = first; number <= last; ++number) out.push_back(number);
  }
  if (out.empty()) throw std::invalid_argument("there is no number");
  return out;
}

Keep keepFromText(const std::string& text) {
  for (const Keep keep : {Keep::kSummary, Keep::kMap, Keep::kAll})
    if (toText(keep) == text) return keep;
  throw ConfigError("keep: '" + text + "' is none of summary, map, all" +
                    didYouMean(text, {"summary", "map", "all"}));
}

std::string toText(Keep keep) {
  return keep == Keep::kSummary ? "summary" : keep == Keep::kMap ? "map" : "all";
}

}  // namespace roomgraph
