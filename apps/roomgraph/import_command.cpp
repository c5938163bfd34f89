// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph import`: a folder in TUM RGB-D format into an MRPT rawlog, with camera and sensor pose.
#include <iostream>
#include <memory>

#include "bag_commands.h"
#include "commands.h"
#include "import_commands.h"
#include "interrupts.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/progress.h"
#include "roomgraph/datasets/camera_presets.h"
#include "roomgraph/datasets/sensor_poses.h"
#include "roomgraph/datasets/tum_import.h"

namespace roomgraph {
namespace {

struct ImportArguments {
  std::filesystem::path folder, rawlog;
  std::string camera, pose;
  TumImportOptions options;
};

// The recording has one sensor, so its label may be left out.
Pose3 poseOf(const ImportArguments& arguments) {
  const std::string context = "--pose " + arguments.pose;
  const auto& label = arguments.options.label;
  if (arguments.pose.find('=') == std::string::npos) return parsePose(arguments.pose, context);
  const SensorPoses poses = parseSensorPoses(arguments.pose, context);
  if (poses.size() != 1 || !poses.contains(label))
    throw ConfigError(context + ": the only sensor is '" + label + "' (see --label)");
  return poses.begin()->second;
}

TumImportOptions optionsOf(const ImportArguments& arguments) {
  TumImportOptions options = arguments.options;
  if (findCameraPreset(arguments.camera))
    options.preset = arguments.camera;
  else if (!arguments.camera.empty())
    options.camera_file = arguments.camera;
  if (!arguments.pose.empty()) options.robot_from_sensor = poseOf(arguments);
  return options;
}

void importFolder(const ImportArguments& arguments) {
  std::unique_ptr<Progress> line;
  catchInterrupts();
  const auto result = importTum(
      arguments.folder, arguments.rawlog, optionsOf(arguments), [&](std::size_t done, std::size_t total) {
        if (!line)
          line = std::make_unique<Progress>(&std::cerr, "import", "images", static_cast<double>(total));
        line->update(static_cast<double>(done));
        if (interrupted())
          throw Interrupted("interrupted: " + arguments.rawlog.string() + " was not written");
      });
  if (line) line->finish();
  tellWarnings(result.warnings);
  std::cout << arguments.rawlog.string() << ": " << result.written << " records '" << arguments.options.label
            << "', " << result.camera.width << "x" << result.camera.height << " px";
  if (result.missing > 0) std::cout << "; " << result.missing << " pairs left out";
  std::cout << "\n";
  if (!result.ground_truth.empty())
    std::cout << result.ground_truth.string() << ": ground truth, camera poses (optical frame)\n";
}

}  // namespace

void addImportCommand(CLI::App& app) {
  auto* importer = app.add_subcommand("import", "Turn other recordings into a rawlog");
  importer->require_subcommand(1);
  auto* tum =
      importer->add_subcommand("tum", "TUM or ICL-NUIM folder: associations.txt, or rgb.txt and depth.txt");
  auto arguments = std::make_shared<ImportArguments>();
  auto& options = arguments->options;
  tum->add_option("DIR", arguments->folder, "folder with the images and their lists")->required();
  tum->add_option("-o,--output", arguments->rawlog, "rawlog to write (gzip inside)")->required();
  tum->add_option("--camera", arguments->camera,
                  "published camera (" + presetNames() +
                      "), or JSON with fx, fy, cx, cy, depth_scale, and if known width, height, distortion "
                      "[k1 k2 p1 p2 k3]; default: camera.json in DIR");
  tum->add_option("--fx", options.fx, "focal length, px");
  tum->add_option("--fy", options.fy, "focal length, px; negative for ICL-NUIM");
  tum->add_option("--cx", options.cx, "principal point, px");
  tum->add_option("--cy", options.cy, "principal point, px");
  tum->add_option("--depth-scale", options.depth_scale,
                  "depth PNG value / scale = metres (TUM, ICL-NUIM: 5000)");
  tum->add_option("--max-difference", options.max_time_difference_s,
                  "largest time between colour and depth, s")
      ->check(atLeastZero())
      ->capture_default_str();
  tum->add_option("--frame-rate", options.frame_rate_hz, "time stamps are frame numbers at this rate, Hz");
  tum->add_option("--label", options.label, "sensor label of the records")->capture_default_str();
  tum->add_option("--pose", arguments->pose,
                  "place of the camera on a robot that drives on the floor: x,y,z,yaw,pitch,roll (m, deg); "
                  "without it the camera is taken for handheld");
  tum->add_flag("--external-images", options.external_images, "keep the images as files in X_Images/");
  tum->callback([arguments] { importFolder(*arguments); });
  addImportBag(*importer);
  addImportCarmen(*importer);
  addImportRtabmap(*importer);
  addImportOpenloris(*importer);
}

}  // namespace roomgraph
