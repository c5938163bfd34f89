// SPDX-License-Identifier: BSD-3-Clause
// Seeds: maps, networks, checkpoints.
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <cstring>

#include "corpus.h"
#include "detection_bytes.h"
#include "roomgraph/core/result_store.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/observations/map_file.h"
#include "sample_map.h"
#include "temporary_folder.h"
#include "tiny_network.h"
#include "view_bytes.h"

namespace roomgraph::fuzz {
namespace {

/// A map of few bytes: all that maps have, with a grid of 20 x 10 cells.
CSemanticMap smallMap() {
  CSemanticMap map = test::sampleMap();
  map.occupancy = mrpt::maps::COccupancyGridMap2D::Create(-1.f, 1.f, 0.f, 1.f, 0.1f);
  map.occupancy->fill(0.99f);
  map.occupancy->setCell(3, 4, 0.01f);
  map.world_from_robot.resize(5);
  return map;
}

// Fields of protocol buffers: number and kind of a field, then its value.
std::string varint(std::uint64_t value) {
  std::string out;
  for (; value > 127; value >>= 7) out += static_cast<char>(value | 0x80);
  return out + static_cast<char>(value);
}
std::string number(int field, std::uint64_t value) {
  return varint(static_cast<std::uint64_t>(field) << 3) + varint(value);
}
std::string text(int field, const std::string& value) {
  return varint(static_cast<std::uint64_t>(field) << 3 | 2) + varint(value.size()) + value;
}

std::string valueInfo(const std::string& name, const std::vector<int>& sizes) {
  std::string shape;
  for (const int size : sizes) shape += text(1, number(1, static_cast<std::uint64_t>(size)));
  return text(1, name) + text(2, text(1, number(1, 1) + text(2, shape)));
}

std::string tensor(const std::string& name, const std::vector<int>& sizes, const std::vector<float>& values) {
  std::string raw(values.size() * sizeof(float), '\0'), out;
  std::memcpy(raw.data(), values.data(), raw.size());
  for (const int size : sizes) out += number(1, static_cast<std::uint64_t>(size));
  return out + number(2, 1) + text(8, name) + text(9, raw);
}

std::string node(const std::string& type, const std::vector<std::string>& inputs, const std::string& output,
                 const std::string& attributes = "") {
  std::string out;
  for (const auto& input : inputs) out += text(1, input);
  return out + text(2, output) + text(3, output) + text(4, type) + attributes;
}

std::string integers(const std::string& name, const std::vector<int>& values) {
  constexpr int kAttribute = 5, kIntegers = 7;
  std::string all = text(1, name);
  for (const int value : values) all += number(8, static_cast<std::uint64_t>(value));
  return text(kAttribute, all + number(20, kIntegers));
}

std::string sizes(const std::string& name, const std::vector<std::int64_t>& values) {
  constexpr int kInt64 = 7;
  std::string raw(values.size() * sizeof(std::int64_t), '\0');
  std::memcpy(raw.data(), values.data(), raw.size());
  return number(1, values.size()) + number(2, kInt64) + text(8, name) + text(9, raw);
}

/// An ONNX model: a convolution of 1 x 1, a ReLU, the maximum over 2 x 2 pixels, all as rows of eight numbers: a box,
/// how sure it is, three classes.
std::string tinyModel() {
  const std::string graph =
      text(1, node("Conv", {"images", "weights", "bias"}, "sums", integers("kernel_shape", {1, 1}))) +
      text(1, node("Relu", {"sums"}, "positive")) +
      text(1, node("MaxPool", {"positive"}, "largest",
                   integers("kernel_shape", {2, 2}) + integers("strides", {2, 2}))) +
      text(1, node("Reshape", {"largest", "rows"}, "boxes")) + text(5, sizes("rows", {1, 64, 8})) +
      text(2, "tiny") + text(5, tensor("weights", {2, 3, 1, 1}, {.1f, .2f, .3f, .4f, .5f, .6f})) +
      text(5, tensor("bias", {2}, {.1f, -.1f})) + text(11, valueInfo("images", {1, 3, 32, 32})) +
      text(12, valueInfo("boxes", {1, 64, 8}));
  return number(1, 7) + text(2, "roomgraph") + text(7, graph) + text(8, number(2, 11));
}

}  // namespace

void addMaps(Corpus& corpus) {
  const test::TemporaryFolder folder;
  const CSemanticMap map = smallMap();
  saveMap(map, folder.file("map.rgmap"));
  corpus.add("map", "small", folder.read("map.rgmap"));
  mrpt::io::CMemoryStream stream;
  mrpt::serialization::archiveFrom(stream) << map;
  corpus.add("map_content", "small",
             {static_cast<const char*>(stream.getRawBufferData()),
              static_cast<std::size_t>(stream.getTotalBytesCount())});
  saveOccupancyRos(*map.occupancy, folder.file("map"));
  corpus.add("occupancy_map", "small", {folder.read("map.yaml"), folder.read("map.pgm")});
}

void addNetworks(Corpus& corpus) {
  const test::TemporaryFolder folder;
  test::writeTinyNetwork(folder, 2);
  corpus.add("darknet", "tiny", {folder.read("tiny.cfg"), "chair\nsofa\n", folder.read("tiny.weights")});
  corpus.add("labels", "two", "chair\nsofa\n");
  corpus.add("onnx", "tiny", {"chair\nsofa\ndoor\n", tinyModel()});
}

void addCheckpoints(Corpus& corpus) {
  const test::TemporaryFolder folder;
  Detection boxed;
  boxed.box = {1, 2, 30, 40};
  boxed.class_name = boxed.label = "chair";
  boxed.score = 0.7;
  boxed.mask = cv::Mat(12, 16, CV_8UC1, cv::Scalar(0));
  boxed.mask(cv::Rect(2, 3, 5, 6)) = 255;
  const std::string boxes = bytesOf(Outcome<std::vector<Detection>>({boxed, boxed}));
  corpus.add("journalled_boxes", "two", boxes);
  corpus.add("journalled_boxes", "none", bytesOf(Outcome<std::vector<Detection>>::failure("too dark")));
  tracking::LocatedView view;
  view.features.keypoints = {{cv::Point2f(1, 2), 1.f}, {cv::Point2f(3, 4), 1.f}};
  view.features.depth = {1.5f, 2.5f};
  view.points = view.in_view = {3, 5};
  corpus.add("journalled_view", "two", tracking::bytesOf(view));
  {
    JournalledResults results(folder.file("results.journal"), "key", 1);
    for (int i = 0; i < 3; ++i) results.keep("boxes", 1000, boxes);
  }
  corpus.add("journal", "boxes", folder.read("results.journal"));
}

}  // namespace roomgraph::fuzz
