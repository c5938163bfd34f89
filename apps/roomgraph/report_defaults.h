// SPDX-License-Identifier: BSD-3-Clause
// What a report needs of the program: the shipped values of its configuration; the report of a run.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace roomgraph {

/// "section.key" -> texts that a configuration as shipped has there.
std::map<std::string, std::vector<std::string>> shippedTexts();

/// Writes the page about the run whose files are in `folder`. A run is a run without it: whatever fails is
/// one line of warning, and false.
bool writeRunReport(const std::filesystem::path& folder, const std::string& name,
                    const std::filesystem::path& html);

}  // namespace roomgraph
