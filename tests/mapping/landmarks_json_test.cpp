// SPDX-License-Identifier: BSD-3-Clause
// landmarks.json: round trip, header, truth files and malformed entries.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "roomgraph/core/errors.h"
#include "roomgraph/mapping/map_files.h"
#include "sample_map.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using ::testing::HasSubstr;
using test::TemporaryFolder;

std::string loadError(const TemporaryFolder& folder, const std::string& text) {
  try {
    loadLandmarksJson(folder.write("x.json", text));
  } catch (const InputError& error) {
    return error.what();
  }
  return "loaded";
}

TEST(LandmarksJson, RoundTrip) {
  const TemporaryFolder folder;
  const auto landmarks = test::sampleMap().landmarks;
  saveLandmarksJson(landmarks, folder.file("landmarks.json"));
  const auto again = loadLandmarksJson(folder.file("landmarks.json"));
  ASSERT_EQ(again.size(), landmarks.size());
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(again[i].id, landmarks[i].id);
    EXPECT_EQ(again[i].class_name, landmarks[i].class_name);
    EXPECT_EQ(again[i].model, landmarks[i].model);
    EXPECT_EQ(again[i].shape.kind, landmarks[i].shape.kind);
    EXPECT_EQ(again[i].shape.width, landmarks[i].shape.width);
    EXPECT_EQ(again[i].shape.depth, landmarks[i].shape.depth);
    EXPECT_EQ(again[i].shape.height, landmarks[i].shape.height);
    EXPECT_EQ(again[i].position, landmarks[i].position);
    EXPECT_EQ(again[i].yaw, landmarks[i].yaw);
    EXPECT_EQ(again[i].has_yaw, landmarks[i].has_yaw);
    EXPECT_EQ(again[i].covariance, landmarks[i].covariance);
    EXPECT_EQ(again[i].existence, landmarks[i].existence);
    EXPECT_EQ(again[i].class_posterior, landmarks[i].class_posterior);
    EXPECT_EQ(again[i].observations, landmarks[i].observations);
  }
}

TEST(LandmarksJson, HeaderAndSightings) {
  const TemporaryFolder folder;
  const auto landmarks = test::sampleMap().landmarks;
  ASSERT_GE(landmarks.size(), 2u);
  const LandmarkId seen = landmarks[0].id;
  saveLandmarksJson(landmarks, folder.file("a.json"),
                    {"lab \"a\".rawlog", "1.2.3", {{seen, {1700000000.25, 1700000009.125}}}});
  const auto json = nlohmann::json::parse(folder.read("a.json"));
  EXPECT_EQ(json["frame"], "world");
  EXPECT_EQ(json["units"], nlohmann::json::parse(R"({"length": "m", "angle": "rad", "time": "s"})"));
  EXPECT_EQ(json["recording"], "lab \"a\".rawlog");
  EXPECT_EQ(json["program"], "roomgraph");
  EXPECT_EQ(json["version"], "1.2.3");
  EXPECT_EQ(json["landmarks"][0]["first_seen"], 1700000000.25);
  EXPECT_EQ(json["landmarks"][0]["last_seen"], 1700000009.125);
  EXPECT_FALSE(json["landmarks"][1].contains("first_seen")) << "not known";
  EXPECT_EQ(loadLandmarksJson(folder.file("a.json")).size(), landmarks.size());
  const auto old = folder.write("old.json", "{\"landmarks\": " + json["landmarks"].dump() + "}");
  EXPECT_EQ(loadLandmarksJson(old).size(), landmarks.size())
      << "without a header, as earlier versions wrote it";
}

TEST(LandmarksJson, FootprintIsInWorld) {
  const TemporaryFolder folder;
  Landmark sofa = test::sampleLandmark(3, "sofa", ShapeKind::kCuboid, 10, 20);
  sofa.shape.width = 2;  // along world x after a quarter turn
  sofa.shape.depth = 1;
  sofa.yaw = M_PI / 2;
  saveLandmarksJson({sofa}, folder.file("a.json"));
  const std::string text = folder.read("a.json");
  const auto start = text.find("\"footprint\":[[");
  ASSERT_NE(start, std::string::npos);
  double x_min = 1e9, x_max = -1e9, y_min = 1e9, y_max = -1e9;
  std::istringstream numbers(text.substr(start + 14));
  char c = 0;
  for (int i = 0; i < 4; ++i) {
    double x = 0, y = 0;
    numbers >> x >> c >> y >> c >> c >> c;
    x_min = std::min(x_min, x), x_max = std::max(x_max, x), y_min = std::min(y_min, y),
    y_max = std::max(y_max, y);
  }
  EXPECT_NEAR(x_min, 9, 1e-9);
  EXPECT_NEAR(x_max, 11, 1e-9);
  EXPECT_NEAR(y_min, 19.5, 1e-9);
  EXPECT_NEAR(y_max, 20.5, 1e-9);
}

TEST(LandmarksJson, EmptyListIsAMapWithoutObjects) {
  const TemporaryFolder folder;
  saveLandmarksJson({}, folder.file("a.json"));
  EXPECT_TRUE(loadLandmarksJson(folder.file("a.json")).empty());
}

TEST(LandmarksJson, ReadsTruthFiles) {
  const TemporaryFolder folder;
  const auto file = folder.write("objects.json", R"({"frame": "world", "objects": [
    {"id": 4, "class": "other", "kind": "wooden chair", "model": "m#1", "x": 1, "y": -2.5, "z": 0, "yaw": 0.5,
     "size_wdh": [0.5, 0.6, 0.7], "moving": false, "footprint": [[0, 0]]},
    {"id": 5, "class": "sofa", "model": "m#2", "x": 0, "y": 0, "z": 0, "size_wdh": [1, 2, 3]}]})");
  const auto objects = loadLandmarksJson(file);
  ASSERT_EQ(objects.size(), 2u);
  EXPECT_EQ(objects[0].model, "wooden chair");
  EXPECT_EQ(objects[0].position, Eigen::Vector3d(1, -2.5, 0));
  EXPECT_TRUE(objects[0].has_yaw);
  EXPECT_EQ(objects[0].shape.depth, 0.6);
  EXPECT_EQ(objects[1].model, "m#2");
  EXPECT_FALSE(objects[1].has_yaw);
  EXPECT_EQ(objects[1].class_posterior.at("sofa"), 1);
}

TEST(LandmarksJson, ErrorsNameFileEntryAndField) {
  const TemporaryFolder folder;
  EXPECT_THAT(loadError(folder, "{"), HasSubstr("x.json: not valid JSON"));
  EXPECT_THAT(loadError(folder, "[]"), HasSubstr("'landmarks' or 'objects'"));
  EXPECT_THAT(loadError(folder, R"({"landmarks": 3})"), HasSubstr("not a list"));
  const std::string good = R"({"id": 1, "class": "sofa", "x": 0, "y": 0, "z": 0, "size_wdh": [1, 1, 1]})";
  EXPECT_EQ(loadError(folder, R"({"landmarks": [)" + good + "]}"), "loaded");
  const auto broken = [&](const std::string& entry) {
    return loadError(folder, "{\"landmarks\": [" + good + ", " + entry + "]}");
  };
  EXPECT_THAT(broken("7"), HasSubstr("landmarks[1]: is not an object"));
  EXPECT_THAT(broken(R"({"id": 1, "class": "sofa", "x": 0, "z": 0, "size_wdh": [1, 1, 1]})"),
              HasSubstr("landmarks[1]: field 'y' is missing"));
  EXPECT_THAT(broken(R"({"id": 1, "class": "sofa", "x": "a", "y": 0, "z": 0, "size_wdh": [1, 1, 1]})"),
              HasSubstr("field 'x' is not a number"));
  EXPECT_THAT(broken(R"({"id": 1, "class": "sofa", "x": 0, "y": 0, "z": 0, "size_wdh": [1, 1]})"),
              HasSubstr("field 'size_wdh' is not a list of 3"));
  EXPECT_THAT(broken(R"({"id": 1, "class": "sofa", "x": 0, "y": 0, "z": 0, "size_wdh": [1, -1, 1]})"),
              HasSubstr("field 'size_wdh' is negative"));
  EXPECT_THAT(broken(R"({"id": 1, "class": 4, "x": 0, "y": 0, "z": 0, "size_wdh": [1, 1, 1]})"),
              HasSubstr("field 'class' is not a text"));
}

TEST(LandmarksJson, UnwritablePlaceIsARunError) {
  const TemporaryFolder folder;
  EXPECT_THROW(saveLandmarksJson({}, folder.file("missing/a.json")), RunError);
  EXPECT_THROW(loadLandmarksJson(folder.file("missing/a.json")), InputError);
}

}  // namespace
}  // namespace roomgraph
