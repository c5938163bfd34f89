// SPDX-License-Identifier: BSD-3-Clause
// Effective configuration of a run against the shipped defaults; figures of evaluations beside it.
#pragma once

#include <filesystem>

#include "run_data.h"

namespace roomgraph {

/// Every key of config.ini; one is changed when none of its shipped texts, and no shipped number, is the
/// same. Keys that `defaults` does not know are not marked. Throws ConfigError or InputError.
std::vector<ConfigRow> readConfigRows(const std::filesystem::path& file,
                                      const std::map<std::string, std::vector<std::string>>& defaults);

/// #rrggbb of every class of objects.ini that has one.
std::map<std::string, std::string> readColours(const std::filesystem::path& file);

/// The JSON files in the folder that `evaluate --json` wrote: objects of numbers, perhaps with a reliability.
std::vector<EvaluationFile> readEvaluations(const std::filesystem::path& folder);

}  // namespace roomgraph
