// SPDX-License-Identifier: BSD-3-Clause
// Candidate file names from every configuration value and list item.
#include "roomgraph/core/mentioned_files.h"

#include <optional>
#include <stdexcept>

#include "roomgraph/core/trim.h"

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

// The name, and what is left of it without a format and a rate at its end, as in net.onnx:yolox@5.
void add(const std::filesystem::path& folder, std::string name, std::vector<std::filesystem::path>& files) {
  files.push_back(folder / name);
  for (const char separator : {'@', ':'}) {
    const auto end = name.rfind(separator);
    if (end == std::string::npos || end == 0 || name.find('/', end) != std::string::npos) continue;
    name = trim(name.substr(0, end));
    if (!name.empty()) files.push_back(folder / name);
  }
}

}  // namespace

std::vector<std::filesystem::path> mentionedFiles(const Config& config) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : config.entries()) {
    const auto names = readAs<std::vector<std::string>>(entry.value).value_or(std::vector<std::string>());
    for (const auto& name : names) add(entry.folder, name, files);
    if (const auto text = readAs<std::string>(entry.value)) add(entry.folder, *text, files);
  }
  return files;
}

}  // namespace roomgraph
