// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph report`: one HTML page about runs, from the files that they wrote.
#include "roomgraph/report/report.h"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>

#include "commands.h"
#include "report_defaults.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"

namespace roomgraph {
namespace {

struct ReportArguments {
  std::vector<std::string> folders;
  std::string truth, output;
};

std::string nameOf(std::string folder) {
  while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  return folder;
}

// Beside the run's other files; of several runs it is nobody's.
std::filesystem::path placeOf(const ReportArguments& arguments) {
  if (!arguments.output.empty()) {
    const auto ending = std::filesystem::path(arguments.output).extension();
    if (ending != ".html" && ending != ".htm")
      throw ConfigError("--output " + arguments.output + ": a report is a page: name it something.html");
    return arguments.output;
  }
  if (arguments.folders.size() > 1)
    throw ConfigError("several runs: say with -o where their report is to go");
  return std::filesystem::path(arguments.folders.front()) / "report.html";
}

void report(const ReportArguments& arguments) {
  const auto place = placeOf(arguments);
  ReportRequest request{{}, arguments.truth, shippedTexts()};
  for (const auto& folder : arguments.folders) request.runs.push_back({folder, nameOf(folder)});
  if (!arguments.truth.empty()) requireOther(place, {arguments.truth});
  const ReportPage page = makeReport(request);
  writeFileAtomically(place, page.html);
  for (const auto& warning : page.warnings) std::cerr << "roomgraph: warning: " << warning << "\n";
  std::printf("%s: %zu %s, %.1f MB\n", place.c_str(), request.runs.size(),
              request.runs.size() == 1 ? "run" : "runs", static_cast<double>(page.html.size()) / 1e6);
}

}  // namespace

void addReportCommand(CLI::App& app) {
  auto arguments = std::make_shared<ReportArguments>();
  auto* command =
      app.add_subcommand("report", "HTML page about runs: map, objects, errors, timings, configuration");
  command->add_option("OUT", arguments->folders, "folders that run wrote; several are compared")->required();
  command->add_option("--truth", arguments->truth, "true trajectory (TUM): errors over time");
  command->add_option("-o,--output", arguments->output, "page to write (default: OUT/report.html)");
  command->footer(
      "The page is one file and loads nothing: it can be sent by mail and opened without a network.\n"
      "Examples:\n"
      "  roomgraph report out/lab\n"
      "  roomgraph report out/lab --truth lab/groundtruth.tum -o lab.html\n"
      "  roomgraph report out/lab out/lidar out/fast -o three.html");
  command->callback([arguments] { report(*arguments); });
}

}  // namespace roomgraph
