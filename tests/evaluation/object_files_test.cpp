// SPDX-License-Identifier: BSD-3-Clause
// Readers of objects and of visibility, on made and real truth files.
#include "roomgraph/evaluation/object_files.h"

#include <gmock/gmock.h>

#include "data_folder.h"
#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/evaluation/object_error.h"
#include "temporary_folder.h"
#include "usual_classes.h"

namespace roomgraph {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using test::messageOf;
using test::TemporaryFolder;

TEST(ObjectFiles, ReadsTruthAndMap) {
  const TemporaryFolder folder;
  const auto truth = readObjects(folder.write("objects.json", R"({"frame": "world", "objects": [
      {"id": 4, "class": "other", "kind": "wooden chair", "x": 1, "y": 2, "z": 0.5, "yaw": -1.5, "size_wdh": [1, 2, 3]}]})"));
  ASSERT_EQ(truth.size(), 1u);
  EXPECT_EQ(truth[0].id, 4);
  EXPECT_EQ(truth[0].kind, "wooden chair");
  EXPECT_EQ(truth[0].position, Eigen::Vector3d(1, 2, 0.5));
  EXPECT_EQ(truth[0].yaw, -1.5);
  EXPECT_EQ(truth[0].width, 1);
  EXPECT_EQ(truth[0].depth, 2);
  EXPECT_EQ(truth[0].height, 3);
  const auto map = readObjects(
      folder.write("landmarks.json", R"({"frame": "world", "units": {"length": "m"}, "version": "1",
      "landmarks": [
      {"id": 0, "class": "sofa", "model": "sofa", "x": 1, "y": 2, "z": 0, "yaw": null, "size_wdh": [1, 2, 3], "existence": 0.7,
       "first_seen": 1, "last_seen": 2},
      {"id": 1, "class": "sofa", "x": 1, "y": 2, "z": 0, "yaw": 1, "has_yaw": false, "size_wdh": [1, 2, 3]}]})"));
  ASSERT_EQ(map.size(), 2u);
  EXPECT_FALSE(map[0].has_yaw);
  EXPECT_EQ(map[0].existence, 0.7);
  EXPECT_FALSE(map[1].has_yaw);
  EXPECT_TRUE(readObjects(folder.write("none.json", R"({"landmarks": []})")).empty());
}

TEST(ObjectFiles, BadFilesNameThePlace) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& text) {
    const auto file = folder.write("bad.json", text);
    return messageOf<InputError>([&] { readObjects(file); });
  };
  EXPECT_THAT(message("{"), HasSubstr("bad.json"));
  EXPECT_THAT(message("{}"), HasSubstr("objects"));
  const auto missing =
      message(R"({"objects": [{"id": 1, "class": "sofa", "x": 1, "z": 0, "size_wdh": [1, 1, 1]}]})");
  EXPECT_THAT(missing, HasSubstr("objects[0]"));
  EXPECT_THAT(missing, HasSubstr("'y'"));
  EXPECT_THAT(
      message(R"({"objects": [{"id": 1, "class": "sofa", "x": 1, "y": 0, "z": 0, "size_wdh": [1, 1]}]})"),
      HasSubstr("size_wdh"));
  EXPECT_THAT(messageOf<InputError>([&] { readObjects(folder.path() / "absent.json"); }),
              HasSubstr("absent.json"));
}

std::string view(int id, double visible, double height, double depth) {
  return R"({"id": )" + std::to_string(id) + R"(, "class": "sofa", "bbox": [0, 10, 50, )" +
         std::to_string(10 + height) + R"(], "visible": )" + std::to_string(visible) + R"(, "z_med": )" +
         std::to_string(depth) + "}";
}

TEST(ObjectFiles, SeenNeedsEnoughGoodFrames) {
  const TemporaryFolder folder;
  std::string text;
  for (int frame = 0; frame < 3; ++frame) {
    text += R"({"frame": 0, "t": 0, "objects": [)";
    text += view(1, 0.5, 50, 2).append(",").append(view(2, 0.3, 50, 2)).append(",");
    text += view(3, 0.5, 40, 2).append(",").append(view(4, 0.5, 50, 4.6));
    if (frame > 0) text.append(",").append(view(5, 0.5, 50, 2));
    text += "]}\n";
  }
  const auto file = folder.write("boxes.jsonl", text);
  VisibilityRule rule;
  rule.min_frames = 3;
  EXPECT_THAT(readSeenObjects(file, rule), ElementsAre(1));
  rule.min_frames = 2;
  EXPECT_THAT(readSeenObjects(file, rule), ElementsAre(1, 5));
  rule.min_visible = 0.2;
  rule.min_height_px = 30;
  rule.max_depth_m = 5;
  EXPECT_THAT(readSeenObjects(file, rule), ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT(readSeenObjects(file), ::testing::IsEmpty());
  folder.write("boxes.jsonl", text + "{\"frame\": 4}\n");
  EXPECT_THAT(messageOf<InputError>([&] { readSeenObjects(file); }), HasSubstr("boxes.jsonl:4"));
}

TEST(ObjectFiles, LabHasTheObjectsItsReadmeNames) {
  const auto lab = test::dataFolder() / "lab/lab_a";
  if (!std::filesystem::exists(lab / "boxes.jsonl")) GTEST_SKIP() << "needs " << lab / "boxes.jsonl";
  const auto truth = readObjects(lab / "objects.json");
  ObjectOptions options;
  options.classes = test::usualClasses();
  options.seen = readSeenObjects(lab / "boxes.jsonl");
  const auto errors = evaluateObjects(truth, {}, options);
  EXPECT_EQ(errors.per_class.at("swivel_chair").missed, 7);
  EXPECT_EQ(errors.per_class.at("sofa").missed, 3);
  EXPECT_EQ(errors.per_class.at("door").missed, 3);
}

}  // namespace
}  // namespace roomgraph
