// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph export`: a rawlog, or the result of a run, for other systems.
#include <iostream>

#include "bag_commands.h"
#include "commands.h"
#include "roomgraph/bags/bag_export.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/datasets/detection_records.h"
#include "roomgraph/datasets/sensor_poses.h"
#include "roomgraph/datasets/tum_export.h"

namespace roomgraph {
namespace {

struct ExportArguments {
  std::filesystem::path input, output;
  std::string label;
};

void warnOf(const std::vector<std::string>& warnings) {
  for (const auto& warning : warnings) std::cerr << "roomgraph: warning: " << warning << "\n";
}

bool isResult(const std::filesystem::path& input) {
  return std::filesystem::is_directory(input) || input.extension() == ".rgmap";
}

void exportBag(const ExportArguments& arguments) {
  ShareProgress progress("export", arguments.output.string());
  const auto result = isResult(arguments.input)
                          ? exportResult(arguments.input, arguments.output)
                          : exportRecording(arguments.input, arguments.output, progress.function());
  progress.finish();
  warnOf(result.warnings);
  std::vector<std::string> counts;
  for (const auto& [topic, count] : result.messages) counts.push_back(topic + " " + std::to_string(count));
  std::cout << arguments.output.string() << ": " << join(counts) << "\n";
}

void exportFolder(const ExportArguments& arguments) {
  ShareProgress progress("export", arguments.output.string());
  const auto result = exportTum(arguments.input, arguments.output, arguments.label, progress.function());
  progress.finish();
  warnOf(result.warnings);
  std::cout << arguments.output.string() << ": " << result.written << " image pairs of '" << result.label
            << "', " << result.camera.width << "x" << result.camera.height << " px";
  if (result.registered > 0)
    std::cout << ", depth of " << result.registered << " projected into the colour image";
  std::cout << (result.ground_truth ? ", with ground truth" : "") << "\n";
  std::cout << "the folder cannot say where the camera sits on the robot: import tum --pose "
            << formatPose(result.robot_from_camera) << "\n";
}

void exportMrpt(const ExportArguments& arguments) {
  ShareProgress progress("export", arguments.output.string());
  const auto result = exportDetectionRecords(arguments.input, arguments.output, progress.function());
  progress.finish();
  if (result.damaged > 0)
    warnOf({std::to_string(result.damaged) + " damaged comments were copied as they are"});
  std::cout << arguments.output.string() << ": " << result.records << " records, " << result.detections
            << " of them roomgraph::CObservationDetections\n";
}

void addMrptExport(CLI::App& command, const std::shared_ptr<ExportArguments>& a) {
  auto* mrpt = command.add_subcommand(
      "mrpt", "Rawlog with boxes as records of their own class, for RawLogViewer and rawlog-edit");
  mrpt->add_option("INPUT", a->input, "X.rawlog")->required();
  mrpt->add_option("-o,--output", a->output, "rawlog to write")->required();
  mrpt->footer(
      "Examples:\n"
      "  roomgraph export mrpt lab.rawlog -o lab_boxes.rawlog\n"
      "  rawlog-edit -p libroomgraph_observations.so --describe -i lab_boxes.rawlog\n"
      "MRPT's programs read it only with that library. More: docs/mrpt.md.");
  mrpt->callback([a] { exportMrpt(*a); });
}

}  // namespace

void addExportCommand(CLI::App& app) {
  auto* command = app.add_subcommand("export", "Recordings and maps for other systems");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  roomgraph export rosbag lab.rawlog -o lab.bag\n"
      "  roomgraph export rosbag out/lab -o map.bag\n"
      "  roomgraph export tum lab.rawlog -o lab_tum\n"
      "  roomgraph export mrpt lab.rawlog -o lab_boxes.rawlog");
  auto a = std::make_shared<ExportArguments>();
  auto* bag = command->add_subcommand(
      "rosbag", "Bag of ROS 1 of a rawlog, or of a run's map, path and objects (for RViz)");
  bag->add_option("INPUT", a->input, "X.rawlog; or a folder that run wrote, or map.rgmap")->required();
  bag->add_option("-o,--output", a->output, "bag to write")->required();
  bag->footer(
      "Examples:\n"
      "  roomgraph export rosbag lab.rawlog -o lab.bag   # import rosbag makes the same records of it\n"
      "  roomgraph export rosbag out/lab -o map.bag      # rosbag play map.bag; RViz with fixed frame map\n"
      "Topics: docs/ros.md.");
  bag->callback([a] { exportBag(*a); });
  auto* tum = command->add_subcommand("tum", "Folder in TUM RGB-D format of a rawlog's images");
  tum->add_option("INPUT", a->input, "X.rawlog")->required();
  tum->add_option("-o,--output", a->output, "folder to make")->required();
  tum->add_option("--label", a->label, "camera (default: the first that appears)");
  tum->footer(
      "Example:\n  roomgraph export tum lab.rawlog -o lab_tum   # import tum makes the same records of it");
  tum->callback([a] { exportFolder(*a); });
  addMrptExport(*command, a);
}

}  // namespace roomgraph
