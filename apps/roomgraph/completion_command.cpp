// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph completion` and `roomgraph manual`: what shells and man(1) read, made of the declarations.
#include <iostream>

#include "command_tree.h"
#include "commands.h"
#include "completion_scripts.h"
#include "manual_page.h"
#include "program.h"
#include "roomgraph/pipeline/setup.h"

namespace roomgraph {
namespace {

std::vector<std::string> allConfigKeys() {
  const ConfigSchema schema = configSchema();
  std::vector<std::string> keys;
  for (const auto& section : schema.sections())
    for (const auto& key : section.keys) keys.push_back(section.name + "." + key.key);
  return keys;
}

std::string completionFor(const std::string& shell, const CommandEntry& root) {
  if (shell == "zsh") return zshCompletion(root);
  return shell == "fish" ? fishCompletion(root) : bashCompletion(root);
}

}  // namespace

void addCompletionCommand(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  auto* command =
      app.add_subcommand("completion", "Script that completes roomgraph's command line in a shell");
  command->add_option("SHELL", *shell, "whose script to print")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->footer(
      "cmake --install puts all three where the shells look for them. Without that:\n"
      "  source <(roomgraph completion bash)\n"
      "  source <(roomgraph completion zsh)\n"
      "  roomgraph completion fish | source");
  command->callback(
      [shell, &app] { std::cout << completionFor(*shell, describeCommands(app, allConfigKeys())); });
}

void addManualCommand(CLI::App& app) {
  auto* command = app.add_subcommand("manual", "Manual page of all commands, as man reads it");
  command->footer("Example:\n  roomgraph manual | man -l -");
  command->callback([&app] { std::cout << manualPage(describeCommands(app, {}), kVersion); });
}

}  // namespace roomgraph
