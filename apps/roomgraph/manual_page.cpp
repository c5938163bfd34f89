// SPDX-License-Identifier: BSD-3-Clause
// roff with the macros of man(7).
#include "manual_page.h"

#include <algorithm>
#include <sstream>

namespace roomgraph {
namespace {

// Text for roff: a backslash and a hyphen of the command line stay what they are, and no line is taken for a
// request.
std::string roffText(const std::string& text) {
  std::string out;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
    line_begins = c == '\n';
  }
  return out;
}

std::string fullName(const CommandEntry& command) {
  std::string name = "roomgraph" + command.path;
  std::replace(name.begin(), name.end(), '/', ' ');
  return name;
}

std::string roffSynopsis(const CommandEntry& command) {
  std::string line = "\\fB" + roffText(fullName(command)) + "\\fR [\\fIOPTIONS\\fR]";
  for (const auto& argument : command.arguments) {
    const std::string name =
        "\\fI" + roffText(argument.names.front()) + "\\fR" + (argument.many ? "..." : "");
    line += argument.required ? " " + name : " [" + name + "]";
  }
  if (!command.commands.empty()) line += " \\fICOMMAND\\fR ...";
  return ".PP\n" + line + "\n";
}

std::string roffOption(const OptionEntry& option, bool argument) {
  std::string names;
  for (const auto& name : option.names)
    names += (names.empty() ? "" : ", ") + std::string(argument ? "\\fI" : "\\fB") + roffText(name) + "\\fR";
  std::string text = ".TP\n" + names + (!argument && option.takes_value ? " \\fIVALUE\\fR" : "") + "\n" +
                     roffText(option.description);
  if (option.required && !argument) text += " (required)";
  if (!option.choices.empty() && !option.choices_go_on) {
    std::string choices;
    for (const auto& choice : option.choices) choices += (choices.empty() ? "" : ", ") + choice;
    text += "; one of " + roffText(choices);
  }
  if (!option.fallback.empty()) text += "; default: " + roffText(option.fallback);
  return text + "\n";
}

// Commands in a footer are indented by two blanks; what lies between them is text.
std::string roffFooter(const std::string& footer) {
  std::istringstream in(footer);
  std::string text;
  bool verbatim = false;
  for (std::string line; std::getline(in, line);) {
    const bool command = line.starts_with("  ");
    if (command && !verbatim) text += ".PP\n.nf\n";
    if (!command && verbatim) text += ".fi\n";
    if (!command) text += ".PP\n";
    verbatim = command;
    text += roffText(line) + "\n";
  }
  return text + (verbatim ? ".fi\n" : "");
}

std::string roffCommand(const CommandEntry& command) {
  std::string text = ".SS " + roffText(fullName(command)) + "\n" + roffText(command.description) + ".\n" +
                     roffSynopsis(command);
  for (const auto& argument : command.arguments) text += roffOption(argument, true);
  for (const auto& option : command.options) text += roffOption(option, false);
  return text + roffFooter(command.footer);
}

}  // namespace

std::string manualPage(const CommandEntry& root, const std::string& version) {
  std::string text = ".\\\" Made by `roomgraph manual`.\n.TH ROOMGRAPH 1 \"\" \"roomgraph " +
                     roffText(version) + "\" \"User Commands\"\n.SH NAME\nroomgraph \\- " +
                     roffText(root.description) +
                     "\n.SH SYNOPSIS\n\\fBroomgraph\\fR [\\fIOPTIONS\\fR] \\fICOMMAND\\fR ...\n.SH OPTIONS\n";
  for (const auto& option : root.options) text += roffOption(option, false);
  text += ".SH COMMANDS\n";
  for (const auto* command : allCommands(root))
    if (!command->path.empty()) text += roffCommand(*command);
  return text + ".SH EXIT STATUS\n" + roffText(root.footer) + "\n";
}

}  // namespace roomgraph
