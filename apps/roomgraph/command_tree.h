// SPDX-License-Identifier: BSD-3-Clause
// The declared command line as plain data: what completion scripts and the manual are made of.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace roomgraph {

struct OptionEntry {
  std::vector<std::string> names;     ///< "-o", "--output"; of an argument its one name, "INPUT"
  std::string description, fallback;  ///< fallback: the declared default, or nothing
  bool takes_value = false;
  bool required = false;
  bool many = false;                 ///< takes several values, or may be repeated
  std::vector<std::string> choices;  ///< the only values allowed; none: any
  bool choices_go_on = false;        ///< choices are beginnings ("lidar.enabled="), the rest is free
};

struct CommandEntry {
  std::string path;  ///< "" of the program itself, "/map/info" of `roomgraph map info`
  std::string name, description, footer;
  std::vector<OptionEntry> options, arguments;
  std::vector<CommandEntry> commands;
};

/// Everything that is declared in `app` and not hidden, in the order of declaration. `config_keys`
/// ("section.key") are offered after --set.
CommandEntry describeCommands(const CLI::App& app, const std::vector<std::string>& config_keys);

/// A command and all below it, itself first.
std::vector<const CommandEntry*> allCommands(const CommandEntry& root);

}  // namespace roomgraph
