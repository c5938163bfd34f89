// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph calibrate`: places of sensors, time offsets, wheels and depth from recordings of ordinary
// driving.
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "interrupts.h"
#include "roomgraph/calibration/calibrate.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/progress.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/datasets/corrected_rawlog.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

struct CalibrateArguments {
  std::vector<std::filesystem::path> recordings;
  std::filesystem::path output, json, rawlog, apply;
  std::vector<std::string> poses;
  std::string board;
  std::optional<int> jpeg_quality;
  ReadOptions read;
  bool quiet = false;
};

// A line for each thing that is done.
class StageProgress {
 public:
  explicit StageProgress(bool quiet) : quiet_(quiet) {}
  void update(const std::string& what, double share) {
    if (interrupted()) throw Interrupted("interrupted: nothing was written");
    if (what != what_) {
      finish();
      line_ = std::make_unique<Progress>(quiet_ ? nullptr : &std::cerr, what, "", 1);
      what_ = what;
    }
    line_->update(share);
  }
  void finish() {
    if (line_) line_->finish();
    line_.reset();
  }

 private:
  bool quiet_;
  std::string what_;
  std::unique_ptr<Progress> line_;
};

struct Shown {
  double factor;
  const char* unit;
};

Shown shownAs(int parameter) {
  const std::string unit = parameterTraits()[static_cast<std::size_t>(parameter)].unit;
  if (unit == "rad") return {kDegreesPerRadian, "deg"};
  if (unit == "s") return {1000, "ms"};
  if (unit == "m") return {1000, "mm"};
  if (unit == "rad/m") return {kDegreesPerRadian, "deg/m"};
  return {1, ""};
}

const char* nameOf(Knowledge knowledge) {
  switch (knowledge) {
    case Knowledge::kFixed:
      return "yes";
    case Knowledge::kPartly:
      return "partly";
    case Knowledge::kUnfixed:
      return "no";
    default:
      return "-";
  }
}

void printTable(const CalibrationReport& report) {
  const CalibrationEstimate& estimate = report.estimate;
  std::printf("%-20s %12s %12s %10s %-6s %s\n", "parameter", "before", "after", "+-", "unit",
              "fixed by this motion");
  for (int i = 0; i < kParameterCount; ++i) {
    const Knowledge knowledge = estimate.knowledge[static_cast<std::size_t>(i)];
    const auto [factor, unit] = shownAs(i);
    const bool known = knowledge == Knowledge::kFixed || knowledge == Knowledge::kPartly;
    char sigma[24] = "-";
    if (known) std::snprintf(sigma, sizeof sigma, "%.2g", factor * estimate.sigma(i));
    std::printf("%-20s %12.4f %12.4f %10s %-6s %s\n", parameterTraits()[static_cast<std::size_t>(i)].name,
                factor * estimate.before[i], factor * estimate.after[i], sigma, unit, nameOf(knowledge));
  }
  for (const auto& text : estimate.unfixed) std::printf("not fixed by this motion: %s\n", text.c_str());
  std::printf("-: held; %s\n", report.frame.c_str());
  std::vector<std::string> used;
  for (const auto& [kind, count] : estimate.measurements) used.push_back(std::to_string(count) + " " + kind);
  std::printf("used: %s\n", join(used).c_str());
}

void writeJson(const CalibrationReport& report, const std::filesystem::path& file) {
  const CalibrationEstimate& estimate = report.estimate;
  nlohmann::ordered_json out{{"frame", report.frame}, {"parameters", nlohmann::ordered_json::array()}};
  for (int i = 0; i < kParameterCount; ++i) {
    const auto& traits = parameterTraits()[static_cast<std::size_t>(i)];
    out["parameters"].push_back({{"name", traits.name},
                                 {"unit", traits.unit},
                                 {"before", estimate.before[i]},
                                 {"after", estimate.after[i]},
                                 {"sigma", estimate.sigma(i)},
                                 {"fixed", nameOf(estimate.knowledge[static_cast<std::size_t>(i)])}});
    std::vector<double> row;
    for (int j = 0; j < kParameterCount; ++j) row.push_back(estimate.covariance(i, j));
    out["covariance"].push_back(row);
  }
  out["not_fixed"] = estimate.unfixed;
  out["measurements"] = estimate.measurements;
  out["scatter_over_usual"] = estimate.noise;
  writeFileAtomically(file, out.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

void correct(const CalibrateArguments& arguments, const std::filesystem::path& calibration,
             StageProgress& progress) {
  if (arguments.rawlog.empty()) throw ConfigError("--apply needs --rawlog, the recording to write");
  const auto left_out = writeCorrectedRawlog(arguments.recordings.front(), arguments.rawlog, readCalibration(calibration),
                                             arguments.jpeg_quality, [&](double share) { progress.update("write", share); });
  progress.finish();
  for (const auto& warning : left_out) std::cerr << "roomgraph: warning: " << warning << "\n";
  std::cout << arguments.rawlog.string() << ": the recording, corrected by " << calibration.string() << "\n";
}

void runCalibrate(CalibrateArguments& arguments) {
  for (const auto& written : {arguments.output, arguments.json, arguments.rawlog})
    if (!written.empty()) requireOther(written, arguments.recordings);
  if (!arguments.rawlog.empty() && arguments.recordings.size() != 1)
    throw ConfigError("--rawlog corrects one recording; " + std::to_string(arguments.recordings.size()) +
                      " are given");
  for (const auto& text : arguments.poses)
    for (const auto& [label, pose] : parseSensorPoses(text, "--pose " + text))
      arguments.read.sensor_poses.insert_or_assign(label, pose);
  catchInterrupts();
  StageProgress progress(arguments.quiet);
  if (!arguments.apply.empty()) return correct(arguments, arguments.apply, progress);
  if (arguments.output.empty()) throw ConfigError("-o names the calibration file to write");
  std::optional<Board> board;
  if (!arguments.board.empty()) board = parseBoard(arguments.board, "--board");
  const auto report = calibrate(arguments.recordings, arguments.read, board,
                                [&](const std::string& what, double share) { progress.update(what, share); });
  progress.finish();
  writeFileAtomically(arguments.output, calibrationText(report));
  if (!arguments.json.empty()) writeJson(report, arguments.json);
  printTable(report);
  std::cout << arguments.output.string() << ": for 'roomgraph run --calibration'\n" << std::flush;
  if (!arguments.rawlog.empty()) correct(arguments, arguments.output, progress);
}

}  // namespace

void addCalibrateCommand(CLI::App& app) {
  auto* command = app.add_subcommand(
      "calibrate", "Find places of sensors, time offsets, wheel and depth scales from ordinary driving");
  auto a = std::make_shared<CalibrateArguments>();
  command->add_option("RAWLOG", a->recordings, "recordings of one robot, used together")->required();
  command->add_option("-o,--output", a->output, "calibration file to write");
  command->add_option("--apply", a->apply,
                      "estimate nothing: write --rawlog with this calibration file applied");
  command->add_option("--json", a->json, "also write all parameters and their covariance to this file");
  command->add_option("--rawlog", a->rawlog, "also write the recording, corrected (gzip inside)");
  command
      ->add_option("--jpeg", a->jpeg_quality,
                   "colour of --rawlog as JPEG of this quality (default: without loss)")
      ->check(CLI::Range(1, 100));
  command
      ->add_option("--pose", a->poses,
                   "place of a sensor to begin with, SENSOR=x,y,z,yaw,pitch,roll (m, deg), instead of the "
                   "recorded one; "
                   "may be repeated")
      ->allow_extra_args(false);
  command->add_option("--board", a->board,
                      "chessboard that stands still in the pictures, used besides walls and floor: inner corners along a "
                      "row and along a column, edge of a square in m, e.g. 9x6x0.04");
  command->add_option("--camera", a->read.rgbd_label, "label of the RGB-D camera (default: the first)");
  command->add_option("--lidar", a->read.lidar_label, "label of the lidar (default: the first)");
  command->add_option("--odometry", a->read.odometry_label,
                      "label of the wheel odometry (default: the first)");
  command->add_flag("--quiet", a->quiet, "no progress");
  command->footer(
      "Examples:\n"
      "  roomgraph calibrate lab.rawlog -o calibration.ini\n"
      "  roomgraph run lab.rawlog -o out/lab --calibration calibration.ini\n"
      "  roomgraph calibrate board.rawlog -o calibration.ini --board 9x6x0.04\n"
      "  roomgraph calibrate monday.rawlog tuesday.rawlog -o calibration.ini --json calibration.json\n"
      "  roomgraph calibrate lab.rawlog -o calibration.ini --rawlog lab_corrected.rawlog\n"
      "  roomgraph calibrate other.rawlog --apply calibration.ini --rawlog other_corrected.rawlog\n"
      "Drive a minute or two along walls, with turns to both sides, and with some floor in view.\n"
      "What fixes which parameter, and how: docs/calibration.md.");
  command->callback([a] { runCalibrate(*a); });
}

}  // namespace roomgraph
