// SPDX-License-Identifier: BSD-3-Clause
// Completion scripts. Each walks the words before the cursor to the sub-command ("/map/info"), then offers
// what belongs there.
#include "completion_scripts.h"

#include "roomgraph/core/suggest.h"

namespace roomgraph {
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

std::string quoted(const std::string& text) {
  return "'" + replaced(text, "'", "'\\''") + "'";
}

std::string fishQuoted(const std::string& text) {
  return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

// Sub-commands, and the values of arguments that allow only some.
std::vector<std::string> wordsOf(const CommandEntry& command) {
  std::vector<std::string> words;
  for (const auto& below : command.commands) words.push_back(below.name);
  for (const auto& argument : command.arguments)
    words.insert(words.end(), argument.choices.begin(), argument.choices.end());
  return words;
}

// "'/map'|'/map/info'": the places of all sub-commands, a pattern of `case`.
std::string placesPattern(const CommandEntry& root) {
  std::vector<std::string> places;
  for (const auto* command : allCommands(root))
    if (!command->path.empty()) places.push_back(quoted(command->path));
  return join(places, "|");
}

// "'/run -o'|'/run --output'": the place and the word before the cursor, a pattern of `case`.
std::string beforeValue(const CommandEntry& command, const OptionEntry& option) {
  std::vector<std::string> patterns;
  for (const auto& name : option.names) patterns.push_back(quoted(command.path + " " + name));
  return join(patterns, "|");
}

std::string bashValues(const CommandEntry& command) {
  std::string text;
  for (const auto& option : command.options) {
    if (!option.takes_value) continue;
    text += "    " + beforeValue(command, option) + ") kind=" + (option.choices_go_on ? "begin" : "value") +
            (option.choices.empty() ? "" : " offered=" + quoted(join(option.choices, " "))) + " ;;\n";
  }
  return text;
}

std::string bashWords(const CommandEntry& command) {
  std::vector<std::string> options;
  for (const auto& option : command.options)
    options.insert(options.end(), option.names.begin(), option.names.end());
  return "      " + quoted(command.path) + ") options=" + quoted(join(options, " ")) +
         " commands=" + quoted(join(wordsOf(command), " ")) + " ;;\n";
}

// "name:description" words of an array, as zsh's _describe reads them.
std::string zshDescribed(const std::string& name, const std::string& description) {
  return " " + quoted(replaced(name, ":", "\\:") + ":" + description);
}

std::string zshValues(const CommandEntry& command) {
  std::string text;
  for (const auto& option : command.options) {
    if (!option.takes_value) continue;
    std::string words;
    for (const auto& choice : option.choices) words += " " + quoted(choice);
    text += "    " + beforeValue(command, option) + ") " +
            (words.empty() ? "_files"
                           : "compadd " + std::string(option.choices_go_on ? "-S '' " : "") + "--" + words) +
            "; return ;;\n";
  }
  return text;
}

std::string zshWords(const CommandEntry& command) {
  std::string options, commands;
  for (const auto& option : command.options)
    for (const auto& name : option.names) options += zshDescribed(name, option.description);
  for (const auto& below : command.commands) commands += zshDescribed(below.name, below.description);
  for (const auto& argument : command.arguments)
    for (const auto& choice : argument.choices) commands += zshDescribed(choice, argument.description);
  return "    " + quoted(command.path) + ")\n      options=(" + options + " )\n      commands=(" + commands +
         " ) ;;\n";
}

std::string fishOption(const OptionEntry& option) {
  std::string line;
  for (const auto& name : option.names)
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (option.takes_value)
    line += option.choices.empty() ? " -r -F" : " -x -a " + fishQuoted(join(option.choices, " "));
  return line + " -d " + fishQuoted(option.description);
}

std::string fishLines(const CommandEntry& command) {
  const std::string start = "complete -c roomgraph -n '__roomgraph_at \"" + command.path + "\"'";
  std::string text;
  for (const auto& below : command.commands)
    text += start + " -f -a " + below.name + " -d " + fishQuoted(below.description) + "\n";
  for (const auto& argument : command.arguments)
    if (!argument.choices.empty())
      text += start + " -f -a " + fishQuoted(join(argument.choices, " ")) + " -d " +
              fishQuoted(argument.description) + "\n";
  for (const auto& option : command.options) text += start + fishOption(option) + "\n";
  return text;
}

}  // namespace

std::string bashCompletion(const CommandEntry& root) {
  std::string values, words;
  for (const auto* command : allCommands(root)) {
    values += bashValues(*command);
    words += bashWords(*command);
  }
  return "# bash completion of roomgraph; made by `roomgraph completion bash`.\n"
         "_roomgraph() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
         "  local place= kind=word offered= options= commands= i\n"
         "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
         "    case \"$place/${COMP_WORDS[i]}\" in\n"
         "      " +
         placesPattern(root) +
         ") place+=/${COMP_WORDS[i]} ;;\n"
         "    esac\n"
         "  done\n"
         "  # Bash cuts --view=top at the equals sign.\n"
         "  if [[ $current == = ]]; then\n"
         "    current=\n"
         "  elif [[ $previous == = ]]; then\n"
         "    previous=${COMP_WORDS[COMP_CWORD - 2]}\n"
         "  fi\n"
         "  case \"$place $previous\" in\n" +
         values +
         "  esac\n"
         "  if [[ $kind == word ]]; then\n"
         "    case \"$place\" in\n" +
         words +
         "    esac\n"
         "    if [[ $current == -* ]]; then offered=$options; else offered=$commands; fi\n"
         "  fi\n"
         "  if [[ $kind == begin ]]; then compopt -o nospace 2>/dev/null; fi\n"
         "  # Without words to offer, the files of `complete -o default` take their place.\n"
         "  mapfile -t COMPREPLY < <(compgen -W \"$offered\" -- \"$current\")\n"
         "}\n"
         "complete -o default -F _roomgraph roomgraph\n";
}

std::string zshCompletion(const CommandEntry& root) {
  std::string values, words;
  for (const auto* command : allCommands(root)) {
    values += zshValues(*command);
    words += zshWords(*command);
  }
  return "#compdef roomgraph\n"
         "# zsh completion of roomgraph; made by `roomgraph completion zsh`.\n"
         "_roomgraph() {\n"
         "  local place= word previous=${words[CURRENT-1]}\n"
         "  local -a options commands\n"
         "  for word in \"${(@)words[2,CURRENT-1]}\"; do\n"
         "    case \"$place/$word\" in\n"
         "      " +
         placesPattern(root) +
         ") place+=/$word ;;\n"
         "    esac\n"
         "  done\n"
         "  case \"$place $previous\" in\n" +
         values +
         "  esac\n"
         "  case \"$place\" in\n" +
         words +
         "  esac\n"
         "  if [[ $PREFIX == -* ]]; then\n"
         "    _describe -o option options\n"
         "  elif (( $#commands )); then\n"
         "    _describe command commands\n"
         "  else\n"
         "    _files\n"
         "  fi\n"
         "}\n"
         "if [[ $funcstack[1] == _roomgraph ]]; then _roomgraph \"$@\"; else compdef _roomgraph roomgraph; "
         "fi\n";
}

std::string fishCompletion(const CommandEntry& root) {
  std::string places, lines;
  for (const auto* command : allCommands(root)) {
    if (!command->path.empty()) places += " " + command->path;
    lines += fishLines(*command);
  }
  return "# fish completion of roomgraph; made by `roomgraph completion fish`.\n"
         "function __roomgraph_at\n"
         "  set -l place ''\n"
         "  for word in (commandline -opc)[2..-1]\n"
         "    contains -- \"$place/$word\"" +
         places +
         "; and set place \"$place/$word\"\n"
         "  end\n"
         "  test \"$place\" = \"$argv[1]\"\n"
         "end\n" +
         lines;
}

}  // namespace roomgraph
