// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph import carmen`: a log of CARMEN into a rawlog.
#include <iostream>
#include <memory>
#include <numbers>

#include "bag_commands.h"
#include "commands.h"
#include "import_commands.h"
#include "roomgraph/imports/carmen_import.h"

namespace roomgraph {
namespace {

struct CarmenArguments {
  std::filesystem::path log, rawlog;
  std::string times = "sender", truth = "auto";
  std::vector<std::string> poses;
  std::optional<double> field_of_view_deg;
  CarmenImportOptions options;
};

void importLog(const CarmenArguments& a) {
  CarmenImportOptions options = a.options;
  options.times = a.times == "logger" ? CarmenTimes::kLogger : CarmenTimes::kSender;
  options.corrected_as_truth = a.truth == "corrected";
  if (a.field_of_view_deg) options.field_of_view = *a.field_of_view_deg * std::numbers::pi / 180;
  options.sensor_poses = posesOf(a.poses);
  ShareProgress progress("import", a.rawlog.string());
  const auto result = importCarmen(a.log, a.rawlog, options, progress.function());
  progress.finish();
  tellWarnings(result.warnings);
  for (const auto& used : result.used) std::cout << used << "\n";
  tellImport({a.rawlog, result.written, result.skipped, result.ground_truth, result.truth});
}

}  // namespace

void addImportCarmen(CLI::App& importer) {
  auto* command =
      importer.add_subcommand("carmen", "Log of CARMEN (.log, .clf, also gzipped): laser scans, odometry");
  auto a = std::make_shared<CarmenArguments>();
  command->add_option("LOG", a->log, "X.log, X.clf, X.log.gz")->required();
  command->add_option("-o,--output", a->rawlog, "rawlog to write (gzip inside)")->required();
  command
      ->add_option("--times", a->times,
                   "sender: ipc_timestamp; logger: logger_timestamp, s after the log's start")
      ->check(CLI::IsMember({"sender", "logger"}))
      ->capture_default_str();
  command
      ->add_option(
          "--fov", a->field_of_view_deg,
          "angle from the first beam of FLASER to the last, deg (default: in steps of PARAM, else 180 "
          "beams from -90 to 89, 181 from -90 to 90, and so on)")
      ->check(CLI::Range(1.0, 360.0));
  command
      ->add_option(
          "--max-range", a->options.max_range_m,
          "readings from there on are no returns, m (default: what the log says, or the codes of a SICK "
          "LMS 2xx)")
      ->check(CLI::PositiveNumber);
  command
      ->add_option(
          "--pose", a->poses,
          "place of a scanner instead of what the log says: LABEL=x,y,z,yaw,pitch,roll (m, deg), LABEL "
          "being FLASER, ROBOTLASER1, ...; may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--truth", a->truth,
          "auto: TRUEPOS of a simulator; corrected: the laser's poses of a log that another program has "
          "corrected")
      ->check(CLI::IsMember({"auto", "corrected"}))
      ->capture_default_str();
  command->footer(
      "Examples:\n"
      "  roomgraph import carmen intel.log -o intel.rawlog\n"
      "  roomgraph import carmen intel.clf.gz -o intel.rawlog --max-range 50\n"
      "  roomgraph import carmen mit.log -o mit.rawlog --pose FLASER=0.1,0,0.3,0,0,0\n"
      "What becomes of each message: docs/imports.md.");
  command->callback([a] { importLog(*a); });
}

}  // namespace roomgraph
