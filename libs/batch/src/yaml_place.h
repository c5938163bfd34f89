// SPDX-License-Identifier: BSD-3-Clause
// A node of a YAML file that knows where it stands, for messages with file, line and key.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <utility>
#include <vector>

namespace roomgraph {

/// A value in a YAML file.
class YamlPlace {
 public:
  /// `key`: how the value is called ("inputs[2].simulate").
  YamlPlace(YAML::Node node, std::string file, std::string key)
      : node_(std::move(node)), file_(std::move(file)), key_(std::move(key)) {}

  /// Throws ConfigError "FILE:LINE: KEY: problem".
  [[noreturn]] void fail(const std::string& problem) const;
  /// "FILE:LINE".
  std::string place() const;

  bool isMap() const { return node_.IsMap(); }
  bool isList() const { return node_.IsSequence(); }
  bool isText() const { return node_.IsScalar(); }

  /// The entries of a map, all of whose keys are `known`. Throws ConfigError: is no map, unknown or repeated
  /// key.
  std::vector<std::pair<std::string, YamlPlace>> entries(const std::vector<std::string>& known) const;
  /// The items of a list, or the value itself as the only one.
  std::vector<YamlPlace> items() const;
  /// Throws ConfigError: is a list or a map.
  std::string text() const;
  std::vector<std::string> texts() const;
  int wholeNumber() const;
  bool yesOrNo() const;

  /// What `read` makes of the text; its std::exception becomes a ConfigError with the place.
  template <class Read>
  auto as(Read read) const {
    const std::string value = text();
    try {
      return read(value);
    } catch (const std::exception& error) {
      fail(error.what());
    }
  }

 private:
  YAML::Node node_;
  std::string file_, key_;
};

/// Throws InputError (not readable) or ConfigError (no YAML: line and cause).
YamlPlace readYaml(const std::string& file);

}  // namespace roomgraph
