// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph vary`: the same drive backwards, mirrored or with less to see, and its truth.
#include <iostream>

#include "bag_commands.h"
#include "commands.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/faults/variant.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

struct VaryArguments {
  std::filesystem::path input, output;
  VariantOptions options;
  double field_of_view_deg = 360;
  std::vector<std::filesystem::path> relations, robot, camera, boxes;
};

// "out/back.rawlog" and "x/lab.relations": out/back.lab.relations.
std::vector<VariantTruth> truthsOf(const VaryArguments& arguments) {
  std::vector<VariantTruth> truths;
  const auto add = [&](const std::vector<std::filesystem::path>& files, VariantTruth::Kind kind) {
    for (const auto& file : files) {
      auto output = arguments.output;
      output.replace_filename(arguments.output.stem().string() + "." + file.filename().string());
      for (const auto& other : truths)
        if (other.output == output) throw ConfigError("two files would become " + output.string());
      truths.push_back({kind, file, output});
    }
  };
  add(arguments.relations, VariantTruth::Kind::kRelations);
  add(arguments.robot, VariantTruth::Kind::kRobotTrajectory);
  add(arguments.camera, VariantTruth::Kind::kCameraTrajectory);
  add(arguments.boxes, VariantTruth::Kind::kBoxes);
  return truths;
}

void vary(VaryArguments arguments) {
  if (arguments.field_of_view_deg < 360) arguments.options.field_of_view_rad = arguments.field_of_view_deg * kDegree;
  const auto truths = truthsOf(arguments);
  ShareProgress progress("vary", arguments.output.string());
  const auto result = writeVariant(arguments.input, arguments.output, arguments.options, truths, progress.function());
  progress.finish();
  for (const auto& [reason, count] : result.skipped) std::cout << "left out: " << count << " x " << reason << "\n";
  if (!result.truncation.empty())
    std::cerr << "roomgraph: warning: " << arguments.input.string() << ": " << result.truncation << "\n";
  for (const auto& truth : truths) std::cout << truth.output.string() << "\n";
  std::cout << arguments.output.string() << ": " << result.written << " records of " << result.read << "\n";
}

void addTruths(CLI::App& command, VaryArguments& a) {
  const auto add = [&](const char* name, std::vector<std::filesystem::path>& files, const char* what) {
    command.add_option(name, files, what)->type_name("FILE")->group("Truth that goes along")->allow_extra_args(false);
  };
  add("--relations", a.relations, "verified relations of the robot: t1 t2 x y z roll pitch yaw");
  add("--robot-trajectory", a.robot, "TUM trajectory of the robot (x forward, y left)");
  add("--camera-trajectory", a.camera, "TUM trajectory of the optical frame");
  add("--boxes", a.boxes, "boxes.jsonl or detections.jsonl");
}

}  // namespace

void addVaryCommand(CLI::App& app) {
  auto* command = app.add_subcommand("vary", "The same drive backwards, mirrored or with less to see: a recording that nothing was tuned to");
  auto a = std::make_shared<VaryArguments>();
  auto& options = a->options;
  command->add_option("RAWLOG", a->input, "recording; it stays as it is")->required();
  command->add_option("-o,--output", a->output, "rawlog to write (gzip inside)")->required();
  const auto change = [&](const char* name, auto& value, const char* what, const char* type) {
    return command->add_option(name, value, what)->type_name(type)->group("Changes, in this order");
  };
  change("--every-scan", options.every_scan, "keep the first of every N scans", "N");
  change("--every-image", options.every_image, "keep the first of every N images, with its detections", "N");
  change("--every-beam", options.every_beam, "keep one of every N beams of a scan", "N");
  change("--field-of-view", a->field_of_view_deg, "of the lidar, about its middle", "DEG")->check(CLI::Range(0.0, 360.0));
  change("--farthest", options.farthest_m, "the lidar has no returns from farther away", "M");
  command->add_flag("--mirrored", options.mirrored, "left and right change places")->group("Changes, in this order");
  change("--stamps-apart", options.stamps_apart_s, "new stamps in the order of the file; equal ones stay equal", "S");
  command->add_flag("--backwards", options.backwards, "the last record becomes the first")->group("Changes, in this order");
  addTruths(*command, *a);
  command->footer(
      "Truths are written beside the rawlog: OUTPUT's name, a dot, and their own. The recording is held in memory. "
      "A variant tells no new rooms, but drives, directions and densities that no value was chosen on; "
      "faults are `roomgraph damage`.\n"
      "Examples:\n"
      "  roomgraph vary fr079.rawlog -o back.rawlog --backwards --relations fr079.relations\n"
      "  roomgraph vary intel.rawlog -o back.rawlog --stamps-apart 0.2 --backwards --relations intel.relations\n"
      "  roomgraph vary intel.rawlog -o thin.rawlog --every-beam 4 --farthest 5\n"
      "  roomgraph vary lab.rawlog -o mirror.rawlog --mirrored --camera-trajectory groundtruth.txt --boxes boxes.jsonl");
  command->callback([a] { vary(*a); });
}

}  // namespace roomgraph
