// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph import rosbag`: bags of ROS 1 and ROS 2 into a rawlog, or a list of what is in them.
#include <cstdio>
#include <iostream>
#include <map>

#include "bag_commands.h"
#include "commands.h"
#include "import_commands.h"
#include "roomgraph/bags/bag_import.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/datasets/camera_presets.h"

namespace roomgraph {
namespace {

struct BagArguments {
  std::filesystem::path bag, rawlog;
  std::string camera, times = "header";
  std::vector<std::string> poses;
  bool list = false;
  BagImportOptions options;
};

const std::map<std::string, BagTimes>& timesByName() {
  static const std::map<std::string, BagTimes> times{
      {"header", BagTimes::kHeader}, {"received", BagTimes::kReceived}, {"corrected", BagTimes::kCorrected}};
  return times;
}

BagImportOptions optionsOf(const BagArguments& arguments) {
  BagImportOptions options = arguments.options;
  options.times = timesByName().at(arguments.times);
  if (!arguments.camera.empty()) options.camera = cameraOption(arguments.camera);
  options.sensor_poses = posesOf(arguments.poses);
  return options;
}

std::string delayOf(const BagTopicInfo& topic) {
  if (!topic.header_minus_received_s) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%+.3f", *topic.header_minus_received_s);
  return text;
}

void list(const BagArguments& arguments) {
  ShareProgress progress("list", "");
  const auto contents = listBag(arguments.bag, progress.function());
  progress.finish();
  tellWarnings(contents.warnings);
  std::printf("%-10s %8s %8s %8s  %-26s %s\n", "used as", "messages", "Hz", "header", "type", "topic");
  for (const auto& topic : contents.topics) {
    const double span = topic.last_s - topic.first_s;
    const double rate = span > 0 ? static_cast<double>(topic.count - 1) / span : 0;
    std::printf("%-10s %8llu %8.1f %8s  %-26s %s%s\n", topic.used_as.empty() ? "-" : topic.used_as.c_str(),
                static_cast<unsigned long long>(topic.count), rate, delayOf(topic).c_str(),
                topic.type.c_str(), topic.name.c_str(),
                topic.detail.empty() ? "" : ("  (" + topic.detail + ")").c_str());
  }
  if (!contents.frames.empty()) std::printf("frames of tf: %s\n", join(contents.frames).c_str());
  std::printf("header: median of header time minus time of reception, s\n");
}

void import(const BagArguments& arguments) {
  if (arguments.rawlog.empty())
    throw ConfigError("-o names the rawlog to write; --list only lists what is in the bag");
  ShareProgress progress("import", arguments.rawlog.string());
  const auto result = importBag(arguments.bag, arguments.rawlog, optionsOf(arguments), progress.function());
  progress.finish();
  tellWarnings(result.warnings);
  for (const auto& used : result.used) std::cout << used << "\n";
  std::cout << "robot: "
            << (result.base_frame.empty() ? "none, the camera is taken for handheld" : result.base_frame)
            << "\n";
  tellImport({arguments.rawlog, result.written, result.skipped, result.ground_truth, result.truth});
}

// How the messages are to be understood.
void addMeaning(CLI::App& command, BagArguments& a) {
  command
      .add_option("--times", a.times,
                  "header: what the drivers wrote; received: when the recorder got it; corrected: the "
                  "former, shifted for "
                  "each topic by its median difference to the latter")
      ->check(CLI::IsMember({"header", "received", "corrected"}))
      ->capture_default_str();
  command
      .add_option("--max-difference", a.options.max_time_difference_s,
                  "largest time between colour and depth, s")
      ->check(atLeastZero())
      ->capture_default_str();
  command.add_option(
      "--camera", a.camera,
      "instead of camera_info: FX,FY,CX,CY in px, or a published camera (" + presetNames() + ")");
  command
      .add_option(
          "--pose", a.poses,
          "place of a sensor instead of tf: LABEL=x,y,z,yaw,pitch,roll (m, deg; x forward); may be repeated")
      ->allow_extra_args(false);
  command
      .add_option("--jpeg", a.options.jpeg_quality,
                  "colour as JPEG of this quality in the rawlog (default: without loss)")
      ->check(CLI::Range(1, 100));
  command.add_flag("--external-images", a.options.external_images,
                   "keep the images as files in X_Images/: no loss beyond that in the bag");
}

void addCommand(CLI::App& importer, const std::string& name, const std::string& description) {
  auto* command = importer.add_subcommand(name, description);
  auto a = std::make_shared<BagArguments>();
  command
      ->add_option("BAG", a->bag,
                   "X.bag of ROS 1; X.db3 or X.mcap of ROS 2, or the folder with metadata.yaml")
      ->required();
  command->add_option("-o,--output", a->rawlog, "rawlog to write (gzip inside)");
  command->add_flag("--list", a->list, "only list topics, frames and clocks");
  command
      ->add_option("--topic", a->options.topics,
                   "NAME, or KIND=NAME with KIND " + join(bagTopicKinds()) +
                       "; stands for those found by type; KIND=none leaves a kind out; may be repeated")
      ->allow_extra_args(false);
  command->add_option(
      "--base", a->options.base_frame,
      "frame of the robot (default: base_footprint, the odometry's child frame, or base_link)");
  command->add_option("--truth", a->options.truth,
                      "ground truth: a frame of tf in which the robot moves, a topic (Odometry, "
                      "PoseStamped), or none (default: "
                      "by name: mocap, vicon, ground_truth, world, map)");
  addMeaning(*command, *a);
  command->footer(
      "Examples:\n"
      "  roomgraph import " +
      name +
      " lab.bag --list\n"
      "  roomgraph import " +
      name +
      " lab.bag -o lab.rawlog\n"
      "  roomgraph import " +
      name +
      " lab.bag -o lab.rawlog --topic depth=/camera/depth_registered/image_raw --topic imu=none\n"
      "  roomgraph import " +
      name +
      " lab_ros2/ -o lab.rawlog --truth mocap\n"
      "What becomes of each message: docs/ros.md.");
  command->callback([a] { a->list ? list(*a) : import(*a); });
}

}  // namespace

void addImportBag(CLI::App& importer) {
  addCommand(importer, "rosbag", "Bag of ROS 1 (.bag) or ROS 2 (SQLite): RGB-D, scans, odometry, IMU, tf");
  addCommand(importer, "rosbag2", "The same: which kind of bag it is, is seen by its content");
}

}  // namespace roomgraph
