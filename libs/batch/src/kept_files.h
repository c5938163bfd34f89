// SPDX-License-Identifier: BSD-3-Clause
// What stays in the folder of a run.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "roomgraph/batch/job_file.h"

namespace roomgraph {

/// Removes what is not to be kept of what `run` writes; other files are left alone.
void removeUnkept(const std::filesystem::path& folder, Keep keep);

/// Sizes of the files in a folder, bytes; the batch's own (task.json, progress) are left out.
std::map<std::string, std::int64_t> filesIn(const std::filesystem::path& folder);

}  // namespace roomgraph
