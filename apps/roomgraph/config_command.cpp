// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph config-reference`: Markdown page of all configuration keys and object database keys.
#include <iostream>

#include "commands.h"
#include "roomgraph/pipeline/setup.h"

namespace roomgraph {
namespace {

constexpr const char* kHeader =
    "# Configuration reference\n\n"
    "Generated from the program's own declarations by `roomgraph config-reference > docs/config.md`; do not "
    "edit.\n\n"
    "A configuration is an INI file (`--config FILE`); single keys are overridden with `--set "
    "section.key=value`. What\n"
    "is not set keeps its default. An unknown section, an unknown key and a value out of range are "
    "errors.\n\n"
    "Comments begin with `#` or `;` at the beginning of a line or after a blank. A text, and each item of a "
    "list, may stand in\n"
    "double quotes (also in `--set`): it must when it holds ` #` or ` ;`, blanks at its ends, a quote at its "
    "beginning or, in\n"
    "a list, a comma. Inside, `\\\"` is a quote, `\\\\` a backslash and `\\n` a new line: `models = "
    "\"/data/a #1, b/x.onnx\", y.onnx`.\n\n";
constexpr const char* kObjects =
    "# Object database\n\n"
    "`objects.ini` (`[pipeline] objects_file`) holds one section per class, named after it. Keys of "
    "each:\n\n";

}  // namespace

void addConfigReferenceCommand(CLI::App& app) {
  auto* command = app.add_subcommand("config-reference", "Reference of all configuration keys, in Markdown");
  command->callback(
      [] { std::cout << kHeader << configSchema().markdown() << kObjects << ObjectDatabase::markdown(); });
}

}  // namespace roomgraph
