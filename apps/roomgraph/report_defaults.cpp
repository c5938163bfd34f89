// SPDX-License-Identifier: BSD-3-Clause
// Defaults out of the configuration schema; a report that cannot fail a run.
#include "report_defaults.h"

#include <iostream>

#include "roomgraph/core/error_text.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/pipeline/setup.h"
#include "roomgraph/report/report.h"

namespace roomgraph {

std::map<std::string, std::vector<std::string>> shippedTexts() {
  std::map<std::string, std::vector<std::string>> texts;
  const ConfigSchema schema = configSchema();
  for (const auto& section : schema.sections())
    for (const auto& key : section.keys) texts[section.name + "." + key.key].push_back(key.default_text);
  texts["pipeline.objects_file"].emplace_back("objects.ini");  // the copy beside the effective configuration
  return texts;
}

bool writeRunReport(const std::filesystem::path& folder, const std::string& name,
                    const std::filesystem::path& html) {
  try {
    const ReportPage page = makeReport({{{folder, name}}, {}, shippedTexts()});
    writeFileAtomically(html, page.html);
    return true;
  } catch (const std::exception& error) {
    std::cerr << "roomgraph: warning: no report.html: " << firstLine(error)
              << " (--no-report: not asked for)\n";
  }
  return false;
}

}  // namespace roomgraph
