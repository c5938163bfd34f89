// SPDX-License-Identifier: BSD-3-Clause
// One HTML page about one or several runs, made from the files that they wrote.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace roomgraph {

/// A folder that `run` wrote, and the name that it has on the page.
struct ReportedRun {
  std::filesystem::path folder;
  std::string name;
};

struct ReportRequest {
  std::vector<ReportedRun> runs;
  std::filesystem::path truth;  ///< true trajectory, for the errors; empty: none
  /// "section.key" -> texts that are as shipped; what has another one is marked as changed.
  std::map<std::string, std::vector<std::string>> defaults;
};

struct ReportPage {
  std::string html;                   ///< complete: styles, scripts, pictures and data are inside
  std::vector<std::string> warnings;  ///< files that are missing or broken; their sections say so, too
};

/// Throws InputError: a folder is none, or has no file of a run; the truth cannot be read.
ReportPage makeReport(const ReportRequest& request);

}  // namespace roomgraph
