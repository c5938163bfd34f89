// SPDX-License-Identifier: BSD-3-Clause
// Reads the declarations of CLI11.
#include "command_tree.h"

#include <sstream>

namespace roomgraph {
namespace {

// CLI11 keeps the values of IsMember in the type's name only: "TEXT:{top,orbit,robot}".
std::vector<std::string> choicesIn(const std::string& type) {
  const auto begin = type.find(":{"), end = type.rfind('}');
  std::vector<std::string> choices;
  if (begin == std::string::npos || end == std::string::npos || end < begin) return choices;
  std::istringstream in(type.substr(begin + 2, end - begin - 2));
  for (std::string choice; std::getline(in, choice, ',');) choices.push_back(choice);
  return choices;
}

OptionEntry describeOption(const CLI::Option& option, const std::vector<std::string>& config_keys) {
  OptionEntry entry;
  for (const auto& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const auto& name : option.get_lnames()) entry.names.push_back("--" + name);
  if (entry.names.empty()) entry.names.push_back(option.get_name());
  entry.description = option.get_description();
  entry.fallback = option.get_default_str();
  entry.takes_value = option.get_items_expected_max() > 0;
  entry.required = option.get_required();
  entry.many = option.get_expected_max() > 1;
  entry.choices = choicesIn(option.get_type_name());
  if (entry.names.back() == "--set") {
    entry.choices_go_on = true;
    for (const auto& key : config_keys) entry.choices.push_back(key + "=");
  }
  return entry;
}

CommandEntry describeBelow(const CLI::App& app, const std::string& path,
                           const std::vector<std::string>& config_keys) {
  CommandEntry entry{path, app.get_name(), app.get_description(), app.get_footer(), {}, {}, {}};
  for (const auto* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    auto& list = option->nonpositional() ? entry.options : entry.arguments;
    list.push_back(describeOption(*option, config_keys));
  }
  for (const auto* command : app.get_subcommands({}))
    if (!command->get_group().empty())
      entry.commands.push_back(describeBelow(*command, path + "/" + command->get_name(), config_keys));
  return entry;
}

}  // namespace

CommandEntry describeCommands(const CLI::App& app, const std::vector<std::string>& config_keys) {
  return describeBelow(app, "", config_keys);
}

std::vector<const CommandEntry*> allCommands(const CommandEntry& root) {
  std::vector<const CommandEntry*> all{&root};
  for (const auto& command : root.commands)
    for (const auto* below : allCommands(command)) all.push_back(below);
  return all;
}

}  // namespace roomgraph
