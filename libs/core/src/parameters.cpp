// SPDX-License-Identifier: BSD-3-Clause
// Parsing, range checks and formatting of parameter values.
#include "roomgraph/core/parameters.h"

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "quoted_text.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph {
namespace {

template <class Number>
Number parseNumber(const std::string& text, std::string_view type, const ParameterInfo& info) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool complete = error == std::errc{} && end == text.data() + text.size();
  if (!complete || !std::isfinite(static_cast<double>(value)) || value < info.min || value > info.max)
    throw std::invalid_argument(describeAllowed(type, info));
  return value;
}

void checkChoice(const std::string& text, const ParameterInfo& info) {
  if (info.choices.empty()) return;
  for (const auto& choice : info.choices)
    if (text == choice) return;
  throw std::invalid_argument(describeAllowed("text", info));
}

}  // namespace

std::string formatParameter(bool value) {
  return value ? "true" : "false";
}
std::string formatParameter(int value) {
  return std::to_string(value);
}
std::string formatParameter(const std::string& value) {
  return quotedWhenNeeded(value, false);
}
std::string formatParameter(const std::vector<std::string>& value) {
  std::vector<std::string> items;
  items.reserve(value.size());
  for (const auto& item : value) items.push_back(quotedWhenNeeded(item, true));
  return join(items);
}

std::string formatParameter(double value) {
  char buffer[64];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return error == std::errc{} ? std::string(buffer, end) : std::to_string(value);
}

void parseParameter(const std::string& text, const ParameterInfo& info, bool& value) {
  if (text == "true" || text == "1" || text == "yes" || text == "on") {
    value = true;
  } else if (text == "false" || text == "0" || text == "no" || text == "off") {
    value = false;
  } else {
    throw std::invalid_argument(describeAllowed("bool", info));
  }
}

void parseParameter(const std::string& text, const ParameterInfo& info, int& value) {
  value = parseNumber<int>(text, "int", info);
}

void parseParameter(const std::string& text, const ParameterInfo& info, double& value) {
  value = parseNumber<double>(text, "number", info);
}

void parseParameter(const std::string& text, const ParameterInfo& info, std::string& value) {
  const std::string meant = unquoted(text);
  checkChoice(meant, info);
  value = meant;
}

void parseParameter(const std::string& text, const ParameterInfo& info, std::vector<std::string>& value) {
  const std::vector<std::string> items = listItems(text);
  for (const auto& item : items) checkChoice(item, info);
  value = items;
}

std::string describeAllowed(std::string_view type, const ParameterInfo& info) {
  if (!info.choices.empty()) {
    std::vector<std::string> names(info.choices.begin(), info.choices.end());
    return "one of " + join(names);
  }
  if (type == "bool") return "true or false";
  if (type == "text") return info.file ? "a file" : "any text";
  if (type == "list") return info.file ? "files separated by commas" : "items separated by commas";
  std::string noun = type == "int" ? "a whole number" : "a number";
  const bool low = std::isfinite(info.min), high = std::isfinite(info.max);
  if (low && high) return noun + " in [" + formatParameter(info.min) + ", " + formatParameter(info.max) + "]";
  if (low) return noun + " >= " + formatParameter(info.min);
  if (high) return noun + " <= " + formatParameter(info.max);
  return noun;
}

}  // namespace roomgraph
