// SPDX-License-Identifier: BSD-3-Clause
// Candidate file names from every configuration value and list item.
#include "roomgraph/core/mentioned_files.h"

#include <optional>
#include <stdexcept>

namespace roomgraph {
namespace {

template <class T>
std::optional<T> readAs(const std::string& text) {
  T value;
  try {
    parseParameter(text, {.doc = ""}, value);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  return value;
}

}  // namespace

std::vector<std::filesystem::path> mentionedFiles(const Config& config) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : config.entries()) {
    const auto names = readAs<std::vector<std::string>>(entry.value).value_or(std::vector<std::string>());
    for (const auto& name : names) files.push_back(entry.folder / name);
    if (const auto text = readAs<std::string>(entry.value)) files.push_back(entry.folder / *text);
  }
  return files;
}

}  // namespace roomgraph
