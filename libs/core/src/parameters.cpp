// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/core/parameters.h"

#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "roomgraph/core/suggest.h"

namespace roomgraph {
namespace {

std::string trim(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

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
  return value;
}
std::string formatParameter(const std::vector<std::string>& value) {
  return join(value);
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
  checkChoice(text, info);
  value = text;
}

void parseParameter(const std::string& text, const ParameterInfo& info, std::vector<std::string>& value) {
  std::vector<std::string> items;
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');) {
    item = trim(item);
    if (item.empty()) continue;
    checkChoice(item, info);
    items.push_back(item);
  }
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
  const std::string noun = type == "int" ? "a whole number" : "a number";
  const bool low = std::isfinite(info.min), high = std::isfinite(info.max);
  if (low && high) return noun + " in [" + formatParameter(info.min) + ", " + formatParameter(info.max) + "]";
  if (low) return noun + " >= " + formatParameter(info.min);
  if (high) return noun + " <= " + formatParameter(info.max);
  return noun;
}

}  // namespace roomgraph
