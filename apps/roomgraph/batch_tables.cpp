// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph batch status|compare|query|export|report|import`: tables and a page from the catalogue.
#include "batch_tables.h"

#include <iostream>
#include <map>
#include <memory>

#include "roomgraph/batch/batch.h"
#include "roomgraph/catalogue/comparison.h"
#include "roomgraph/catalogue/figure_page.h"
#include "roomgraph/catalogue/text_table.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/progress.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

struct TableOptions {
  std::string folder, sql, output, format = "csv";
  ComparisonChoice choice;
  bool csv = false;
};

Catalogue catalogueIn(const std::string& folder) {
  const fs::path file = fs::path(folder) / "catalogue.sqlite";
  if (!fs::exists(file) && fs::is_directory(fs::path(folder) / "runs"))
    throw InputError(file.string() + ": is not there; 'roomgraph batch import " + folder +
                     "' makes it from the runs");
  return Catalogue::forReading(file);
}

void showStatus(const TableOptions& options) {
  constexpr std::size_t kShownFailures = 20;
  const Catalogue catalogue = catalogueIn(options.folder);
  const auto runs = catalogue.runs();
  std::map<std::string, std::map<std::string, int>> by_variant;
  TextTable wrong{{"run", "status", "attempts", "reason"}, {}, {false, false, true, false}};
  for (const auto& run : runs) {
    ++by_variant[run.variant][run.status];
    if ((run.status != "complete" || !run.reason.empty()) && wrong.rows.size() < kShownFailures)
      wrong.rows.push_back({run.name, run.status,
                            std::to_string(run.failed_attempts + (run.status == "complete")), run.reason});
  }
  TextTable counts{{"variant", "complete", "failed", "interrupted"}, {}, {false, true, true, true}};
  for (const auto& [variant, states] : by_variant) {
    std::vector<std::string> row{variant};
    for (const char* state : {"complete", "failed", "interrupted"})
      row.push_back(std::to_string(states.contains(state) ? states.at(state) : 0));
    counts.rows.push_back(row);
  }
  std::cout << runs.size() << " runs\n\n" << alignedText(counts);
  if (!wrong.rows.empty()) std::cout << "\n" << alignedText(wrong);
  const Comparison comparison = compareVariants(catalogue, options.choice);
  if (comparison.rows.empty()) return;
  std::cout << "\nMedian (quartiles) over " << comparison.inputs << " inputs; *: differs from "
            << comparison.variants.front() << " (roomgraph batch compare)\n\n"
            << alignedText(spreadTable(comparison));
}

void showComparison(const TableOptions& options) {
  const Comparison comparison = compareVariants(catalogueIn(options.folder), options.choice);
  const TextTable table = differenceTable(comparison);
  if (options.csv) {
    std::cout << csvText(table);
    return;
  }
  if (table.rows.empty()) {
    std::cout << "nothing to compare: there are no two variants with complete runs of one input\n";
    return;
  }
  std::cout << "Differences from " << comparison.variants.front()
            << ", input by input; interval of the median; p: Wilcoxon's "
            << "signed-rank test, two-sided\n\n"
            << alignedText(table);
}

void showQuery(const TableOptions& options) {
  const TextTable table = catalogueIn(options.folder).query(options.sql);
  std::cout << (options.csv ? csvText(table) : alignedText(table));
}

void exportTable(const TableOptions& options) {
  const std::string text = csvText(wideTable(catalogueIn(options.folder)));
  if (options.output.empty())
    std::cout << text;
  else
    writeFileAtomically(options.output, text);
}

void writePage(const TableOptions& options) {
  const fs::path folder = fs::absolute(options.folder).lexically_normal();
  const fs::path place =
      options.output.empty() ? folder / "report.html" : fs::absolute(options.output).lexically_normal();
  const fs::path runs = folder / "runs";
  const std::string name =
      folder.has_filename() ? folder.filename().string() : folder.parent_path().filename().string();
  writeFileAtomically(
      place, batchPage(catalogueIn(options.folder), options.choice,
                       {"Batch " + name, runs, runs.lexically_relative(place.parent_path()).string()}));
  std::cout << place.string() << "\n";
}

void importResults(const TableOptions& options) {
  const fs::path folder = options.folder;
  if (!fs::is_directory(folder / "runs"))
    throw InputError(options.folder + ": is no folder of a batch: it has no runs");
  const BatchLock lock(folder);
  Catalogue catalogue = Catalogue::forWriting(folder / "catalogue.sqlite");
  std::size_t changed = 0;
  std::unique_ptr<Progress> line;
  const auto problems = catalogue.importFolder(folder / "runs", [&](std::size_t done, std::size_t total) {
    if (!line) line = std::make_unique<Progress>(&std::cerr, "import", "results", static_cast<double>(total));
    line->update(static_cast<double>(done));
    changed = total;
  });
  if (line) line->finish();
  for (const auto& problem : problems) std::cerr << "roomgraph: warning: " << problem << "\n";
  std::cout << changed - problems.size() << " results taken in, " << catalogue.runs().size()
            << " runs in all\n";
}

CLI::App* addTable(CLI::App& batch, const std::shared_ptr<TableOptions>& options, const char* name,
                   const char* text, void (*action)(const TableOptions&)) {
  auto* command = batch.add_subcommand(name, text);
  command->add_option("DIR", options->folder, "folder of the batch")->required();
  command->callback([options, action] { action(*options); });
  return command;
}

void addChoice(CLI::App& command, TableOptions& options) {
  command.add_option("--baseline", options.choice.baseline,
                     "variant that others are compared with (default: 'default', else the first)");
  command.add_option("--group", options.choice.group, "only inputs of this group");
  command.add_option("--figure", options.choice.figures, "only this figure; may be repeated");
}

}  // namespace

void addBatchTables(CLI::App& batch) {
  const auto options = [] { return std::make_shared<TableOptions>(); };
  auto status = options(), compare = options(), query = options(), exported = options(), page = options(),
       taken = options();
  addChoice(*addTable(batch, status, "status", "Runs by variant, what failed and why, figures", showStatus),
            *status);
  auto* comparison = addTable(batch, compare, "compare",
                              "Differences between variants, with intervals and tests", showComparison);
  addChoice(*comparison, *compare);
  comparison->add_flag("--csv", compare->csv, "as CSV");
  auto* select = addTable(batch, query, "query", "Ask the catalogue in SQL", showQuery);
  select->add_option("SQL", query->sql, "a SELECT")->required();
  select->add_flag("--csv", query->csv, "as CSV");
  select->footer(
      "Tables: runs, inputs, figures (run, input, input_group, seed, variant, figure, value, revision), "
      "parameters,\n"
      "run_parameters (run, variant, parameter, value), timings, failures, files.\n"
      "Example:\n  roomgraph batch query out/batch \"SELECT variant, avg(value) FROM figures WHERE figure = "
      "'trajectory.ate_rmse_m' GROUP BY variant\"");
  auto* table = addTable(batch, exported, "export", "All runs with all figures, one run a row", exportTable);
  table->add_option("FORMAT", exported->format, "csv")->check(CLI::IsMember({"csv"}))->capture_default_str();
  table->add_option("-o,--output", exported->output, "file (default: standard output)");
  auto* html =
      addTable(batch, page, "report", "One HTML page, with links to the report of each run", writePage);
  html->add_option("-o,--output", page->output, "file (default: DIR/report.html)");
  addChoice(*html, *page);
  addTable(batch, taken, "import", "Make the catalogue again, or bring it up to date, from the runs in DIR",
           importResults);
}

}  // namespace roomgraph
