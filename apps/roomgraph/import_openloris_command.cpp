// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph import openloris`: the folder of a sequence of OpenLORIS-Scene into a rawlog.
#include <memory>

#include "bag_commands.h"
#include "commands.h"
#include "import_commands.h"
#include "roomgraph/datasets/camera_presets.h"
#include "roomgraph/imports/openloris_import.h"

namespace roomgraph {
namespace {

struct OpenlorisArguments {
  std::filesystem::path folder, rawlog;
  std::string camera;
  std::vector<std::string> poses;
  OpenlorisImportOptions options;
};

void importSequence(const OpenlorisArguments& a) {
  OpenlorisImportOptions options = a.options;
  if (!a.camera.empty()) options.camera = cameraOption(a.camera);
  options.sensor_poses = posesOf(a.poses);
  ShareProgress progress("import", a.rawlog.string());
  const auto result = importOpenloris(a.folder, a.rawlog, options, progress.function());
  progress.finish();
  tellWarnings(result.warnings);
  tellImport(
      {a.rawlog, result.written, result.skipped, result.ground_truth, "poses of the robot (base_link)"});
}

}  // namespace

void addImportOpenloris(CLI::App& importer) {
  auto* command = importer.add_subcommand(
      "openloris", "Folder of a sequence of OpenLORIS-Scene: RGB-D of the D435i, wheel odometry");
  auto a = std::make_shared<OpenlorisArguments>();
  command
      ->add_option("DIR", a->folder, "folder with color.txt, aligned_depth.txt, odom.txt, sensors.yaml, ...")
      ->required();
  command->add_option("-o,--output", a->rawlog, "rawlog to write (gzip inside)")->required();
  command
      ->add_option("--max-difference", a->options.max_time_difference_s,
                   "largest time between colour and depth, s")
      ->check(atLeastZero())
      ->capture_default_str();
  command->add_option(
      "--camera", a->camera,
      "instead of sensors.yaml: FX,FY,CX,CY in px, or a published camera (" + presetNames() + ")");
  command
      ->add_option("--pose", a->poses,
                   "place of the camera instead of trans_matrix.yaml: D400=x,y,z,yaw,pitch,roll (m, deg; x "
                   "forward)")
      ->allow_extra_args(false);
  command
      ->add_option("--jpeg", a->options.jpeg_quality,
                   "colour as JPEG of this quality in the rawlog (default: without loss)")
      ->check(CLI::Range(1, 100));
  command->add_flag("--external-images", a->options.external_images, "keep the images as files in X_Images/");
  command->footer(
      "Examples:\n"
      "  roomgraph import openloris office1-1 -o office1-1.rawlog\n"
      "  roomgraph import openloris home1-1 -o home1-1.rawlog --external-images\n"
      "What becomes of each file: docs/imports.md.");
  command->callback([a] { importSequence(*a); });
}

}  // namespace roomgraph
