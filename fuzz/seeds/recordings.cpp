// SPDX-License-Identifier: BSD-3-Clause
// Seeds: rawlogs in all formats, folders of TUM, bags.
#include <cstdlib>
#include <iostream>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "bag_reader.h"
#include "corpus.h"
#include "mcap_maker.h"
#include "three_frames.h"

namespace roomgraph::fuzz {
namespace {

constexpr int kWidth = 16, kHeight = 12;  // px; the smallest images that are still images

std::string encoded(const cv::Mat& image, const char* ending) {
  std::vector<unsigned char> bytes;
  cv::imencode(ending, image, bytes);
  return {bytes.begin(), bytes.end()};
}
std::string colorImage(const char* ending) {
  return encoded(cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar(10, 120, 230)), ending);
}
std::string depthImage() {
  return encoded(cv::Mat(kHeight, kWidth, CV_16UC1, cv::Scalar(10000)), ".png");
}

std::string gzipped(const std::vector<test::Object>& records) {
  const test::TemporaryFolder folder;
  test::writeRawlog(folder.file("x.rawlog"), records);
  return folder.read("x.rawlog");
}

/// A bag of tests/bags/write_bag.py; empty when it cannot be made.
std::string bagOf(const test::TemporaryFolder& folder, const std::string& name, const std::string& options) {
  const std::string command = "PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 '" ROOMGRAPH_SOURCE_DIR
                              "/tests/bags/write_bag.py' '" +
                              folder.file(name).string() + "' '" + options + "' 2>/dev/null";
  if (std::system(command.c_str()) != 0) return "";
  return folder.read(name);
}

/// The messages of a bag as inputs of the target bag_message, which chooses the type by the first byte.
void addMessages(Corpus& corpus, const std::filesystem::path& bag, const std::string& name) {
  const std::map<std::string, int> types{{"sensor_msgs/Image", 0},      {"sensor_msgs/CompressedImage", 1},
                                         {"sensor_msgs/CameraInfo", 2}, {"sensor_msgs/LaserScan", 3},
                                         {"nav_msgs/Odometry", 4},      {"geometry_msgs/PoseStamped", 5},
                                         {"tf2_msgs/TFMessage", 6},     {"sensor_msgs/Imu", 7}};
  const auto reader = bags::openBag(bag);
  bags::RawMessage message;
  std::map<std::string, int> taken;
  while (reader->next(message)) {
    const auto& topic = reader->topics()[message.topic];
    const auto type = types.find(topic.type);
    if (type == types.end() || taken[topic.name]++ > 0) continue;
    std::string bytes(1, static_cast<char>(type->second | (message.cdr ? 0x80 : 0)));
    bytes.append(reinterpret_cast<const char*>(message.bytes.data()), message.bytes.size());
    corpus.add("bag_message", name + "_" + std::to_string(message.topic), bytes);
  }
}

}  // namespace

void addRawlogs(Corpus& corpus) {
  const auto frames = test::threeFrames(kWidth, kHeight), pairs = test::threePairs(kWidth, kHeight);
  for (const char* target : {"rawlog", "rawlog_info", "rawlog_copy", "rawlog_observations"}) {
    corpus.add(target, "observations", frames.bytes());
    corpus.add(target, "pairs", pairs.bytes());
    corpus.add(target, "gzipped", gzipped(frames.records));
    corpus.add(target, "scans",
               test::bytesOf(test::makeScan(1)) + test::bytesOf(test::makeOdometry(2, 1, 1, 0)));
  }
  const test::TemporaryFolder folder;
  test::makeImages(1000)->rangeImage_convertToExternalStorage("depth.bin", folder.path().string() + "/");
  for (const char* ending : {".jpg", ".png", ".ppm", ".bmp"})
    corpus.add("rawlog_images", ending + 1, {colorImage(ending), folder.read("depth.bin")});
}

void addFolders(Corpus& corpus) {
  const std::string camera =
      R"({"width": 16, "height": 12, "fx": 10, "fy": -11, "cx": 7.5, "cy": 5.5, "distortion": [0, 0.1, 0, 0, 0], "depth_scale": 5000})";
  const std::string truth = "# t x y z q\n1 0.1 0.2 0.3 0 0 0 1\n2 0.2 0.2 0.3 0 0 0.0998334 0.9950042\n";
  corpus.add("tum", "png",
             {camera, "1.5 color.png 1.51 depth.png\n# x\n2.5 color.png 2.51 depth.png\n", truth,
              colorImage(".png"), depthImage()});
  corpus.add("tum_lists", "jpg",
             {camera, "1.5 color.jpg\n2.5 color.jpg\n", "1.51 depth.png\n2.49 depth.png\n", truth,
              colorImage(".jpg"), depthImage()});
}

void addBags(Corpus& corpus) {
  const std::map<std::string, std::string> options{
      {"plain", R"({"seconds": 0.2})"},
      {"bz2", R"({"seconds": 0.2, "compression": "bz2", "color": "png", "depth": "rvl"})"},
      {"lz4", R"({"seconds": 0.2, "compression": "lz4", "depth": "compressedDepth"})"},
      {"depth32", R"({"seconds": 0.1, "color": "mono8", "depth": "compressedDepth32", "truth": "topic"})"},
      {"cdr", R"({"seconds": 0.2, "ros2": "<", "color": "png", "depth": "rvl"})"},
      {"cdr_big", R"({"seconds": 0.1, "ros2": ">", "depth": "32FC1", "truth": "topic"})"}};
  for (const auto& [name, json] : options) {
    const bool ros2 = json.find("ros2") != std::string::npos;
    const test::TemporaryFolder folder;
    const std::string bag = ros2 ? "x.db3" : "x.bag", bytes = bagOf(folder, bag, json);
    if (bytes.empty()) {
      std::cerr << "fuzz_seeds: no bag '" << name << "': tests/bags/write_bag.py cannot make it here\n";
      continue;
    }
    corpus.add(ros2 ? "bag_ros2" : "bag_ros1", name, bytes);
    addMessages(corpus, folder.file(bag), name);
    if (!ros2) continue;
    corpus.add("bag_mcap", name + "_lz4", test::mcapOf(folder.file(bag), {.compression = "lz4"}));
    corpus.add("bag_mcap", name + "_zstd",
               test::mcapOf(folder.file(bag), {.compression = "zstd", .checksums = false, .summary = true}));
    corpus.add("bag_mcap", name + "_plain", test::mcapOf(folder.file(bag), {.chunk_bytes = 0}));
  }
}

}  // namespace roomgraph::fuzz
