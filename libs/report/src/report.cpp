// SPDX-License-Identifier: BSD-3-Clause
// From folders of runs to the page, with a warning for every file that could not be used.
#include "roomgraph/report/report.h"

#include "data_json.h"
#include "page.h"

namespace roomgraph {

ReportPage makeReport(const ReportRequest& request) {
  std::vector<RunData> runs;
  ReportPage out;
  for (const auto& run : request.runs) {
    runs.push_back(gatherRun(run, request));
    for (const auto& [file, cause] : runs.back().missing)
      out.warnings.push_back((run.folder / file).string() + ": " + cause);
    if (!request.truth.empty() && !runs.back().final_errors)
      out.warnings.push_back(request.truth.string() + ": no pose of " + run.name +
                             " has a true one within 20 ms");
  }
  out.html = pageAround(dataJson(runs));
  return out;
}

}  // namespace roomgraph
