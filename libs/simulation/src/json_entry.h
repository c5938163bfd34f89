// SPDX-License-Identifier: BSD-3-Clause
// Typed access to the keys of a JSON object, with errors that name the place.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace roomgraph {

/// An object of a JSON file that knows its place: every problem names file and entry. Keys that were never
/// asked for are unknown keys.
class JsonEntry {
 public:
  JsonEntry(const nlohmann::json& value, std::string file, std::string place);

  bool has(const std::string& key) const { return value_.contains(key) && !value_.at(key).is_null(); }
  /// Finite number in [min, max]; without a fallback it must be there.
  double number(const std::string& key, std::optional<double> fallback, double min, double max);
  int integer(const std::string& key, std::optional<int> fallback, int min, int max);
  bool flag(const std::string& key, bool fallback);
  std::string text(const std::string& key, std::optional<std::string> fallback);
  /// Text that must be one of `choices`.
  std::string choice(const std::string& key, const std::optional<std::string>& fallback,
                     const std::vector<std::string>& choices);
  /// Array of `count` coordinates or sizes, m: within 1000 m.
  std::vector<double> numbers(const std::string& key, std::size_t count);
  /// "#rrggbb" as shares in [0, 1].
  std::array<double, 3> color(const std::string& key, const std::array<double, 3>& fallback);
  std::vector<Eigen::Vector2d> path(const std::string& key);
  /// The object under a key, or an empty one.
  JsonEntry child(const std::string& key);
  /// The objects of an array, or none.
  std::vector<JsonEntry> children(const std::string& key);

  /// Throws ConfigError when a key was not asked for.
  void finish() const;
  /// Folder of the file.
  std::filesystem::path folder() const { return std::filesystem::path(file_).parent_path(); }
  /// "rooms[1].width_m" (or only the entry without a key).
  std::string place(const std::string& key = "") const;
  /// Throws ConfigError "file: place: what".
  [[noreturn]] void fail(const std::string& key, const std::string& what) const;

 private:
  const nlohmann::json* find(const std::string& key);
  double checked(const nlohmann::json& value, const std::string& key) const;
  double coordinate(const nlohmann::json& value, const std::string& key) const;

  nlohmann::json value_;
  std::string file_, place_;
  std::set<std::string> known_;
};

}  // namespace roomgraph
