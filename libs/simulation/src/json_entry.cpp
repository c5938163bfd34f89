// SPDX-License-Identifier: BSD-3-Clause
// Checks of numbers, texts, colours and paths in JSON entries; unknown keys.
#include "json_entry.h"

#include <cmath>
#include <optional>
#include <sstream>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph {
namespace {

std::string range(double min, double max) {
  std::ostringstream out;
  out << "a number in [" << min << ", " << max << "]";
  return out.str();
}

}  // namespace

JsonEntry::JsonEntry(const nlohmann::json& value, std::string file, std::string place)
    : value_(value), file_(std::move(file)), place_(std::move(place)) {
  if (!value_.is_object()) fail("", "must be an object {…}");
}

std::string JsonEntry::place(const std::string& key) const {
  if (key.empty()) return place_.empty() ? "the world" : place_;
  return place_.empty() ? key : place_ + "." + key;
}

void JsonEntry::fail(const std::string& key, const std::string& what) const {
  throw ConfigError(file_ + ": " + place(key) + ": " + what);
}

const nlohmann::json* JsonEntry::find(const std::string& key) {
  known_.insert(key);
  return has(key) ? &value_.at(key) : nullptr;
}

double JsonEntry::checked(const nlohmann::json& value, const std::string& key) const {
  if (!value.is_number() || !std::isfinite(value.get<double>()))
    fail(key, "must be a number, is " + value.dump());
  return value.get<double>();
}

double JsonEntry::coordinate(const nlohmann::json& value, const std::string& key) const {
  constexpr double kFarthest_m = 1000;
  const double metres = checked(value, key);
  if (std::abs(metres) > kFarthest_m) fail(key, "must be within 1000 m, is " + value.dump());
  return metres;
}

double JsonEntry::number(const std::string& key, std::optional<double> fallback, double min, double max) {
  const auto* found = find(key);
  if (!found && !fallback) fail(key, "is missing; must be " + range(min, max));
  if (!found) return *fallback;
  const double value = checked(*found, key);
  if (value < min || value > max) fail(key, "must be " + range(min, max) + ", is " + found->dump());
  return value;
}

int JsonEntry::integer(const std::string& key, std::optional<int> fallback, int min, int max) {
  const double value = number(key, fallback, min, max);
  if (value != std::floor(value)) fail(key, "must be a whole number");
  return static_cast<int>(value);
}

bool JsonEntry::flag(const std::string& key, bool fallback) {
  const auto* found = find(key);
  if (!found) return fallback;
  if (!found->is_boolean()) fail(key, "must be true or false, is " + found->dump());
  return found->get<bool>();
}

std::string JsonEntry::text(const std::string& key, std::optional<std::string> fallback) {
  const auto* found = find(key);
  if (!found && !fallback) fail(key, "is missing");
  if (!found) return *fallback;
  if (!found->is_string()) fail(key, "must be a text, is " + found->dump());
  return found->get<std::string>();
}

std::string JsonEntry::choice(const std::string& key, const std::optional<std::string>& fallback,
                              const std::vector<std::string>& choices) {
  const auto* found = find(key);
  if (!found && !fallback) fail(key, "is missing; one of " + join(choices));
  std::string value = text(key, fallback);
  for (const auto& allowed : choices)
    if (value == allowed) return value;
  fail(key, "unknown '" + value + "'" + didYouMean(value, choices) + "; one of " + join(choices));
}

std::vector<double> JsonEntry::numbers(const std::string& key, std::size_t count) {
  const auto* found = find(key);
  if (!found || !found->is_array() || found->size() != count)
    fail(key,
         (found ? "must be" : "is missing; must be") + (" a list of " + std::to_string(count)) + " numbers");
  std::vector<double> out;
  for (const auto& item : *found) out.push_back(coordinate(item, key));
  return out;
}

std::array<double, 3> JsonEntry::color(const std::string& key, const std::array<double, 3>& fallback) {
  if (!find(key)) return fallback;
  const std::string code = text(key, "");
  if (code.size() != 7 || code[0] != '#' ||
      code.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
    fail(key, "must be a colour as \"#rrggbb\", is \"" + code + "\"");
  std::array<double, 3> out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = std::stoi(code.substr(1 + 2 * i, 2), nullptr, 16) / 255.0;
  return out;
}

std::vector<Eigen::Vector2d> JsonEntry::path(const std::string& key) {
  const auto* found = find(key);
  if (!found || !found->is_array() || found->empty()) fail(key, "must be a list of points [x, y]");
  std::vector<Eigen::Vector2d> out;
  for (std::size_t i = 0; i < found->size(); ++i) {
    const auto& point = found->at(i);
    const std::string item = key + "[" + std::to_string(i) + "]";
    if (!point.is_array() || point.size() != 2) fail(item, "must be a point [x, y]");
    out.emplace_back(coordinate(point[0], item), coordinate(point[1], item));
  }
  return out;
}

JsonEntry JsonEntry::child(const std::string& key) {
  const auto* found = find(key);
  return {found ? *found : nlohmann::json::object(), file_, place(key)};
}

std::vector<JsonEntry> JsonEntry::children(const std::string& key) {
  const auto* found = find(key);
  std::vector<JsonEntry> out;
  if (!found) return out;
  if (!found->is_array()) fail(key, "must be a list");
  for (std::size_t i = 0; i < found->size(); ++i)
    out.emplace_back(found->at(i), file_, place(key) + "[" + std::to_string(i) + "]");
  return out;
}

void JsonEntry::finish() const {
  for (const auto& item : value_.items()) {
    if (known_.count(item.key())) continue;
    const std::vector<std::string> names(known_.begin(), known_.end());
    fail(item.key(), "unknown key" + didYouMean(item.key(), names) + "; known here: " + join(names));
  }
}

}  // namespace roomgraph
