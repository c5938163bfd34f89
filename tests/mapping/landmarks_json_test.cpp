// SPDX-License-Identifier: BSD-3-Clause
// landmarks.json as it is written, read back with a JSON parser.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "roomgraph/core/errors.h"
#include "roomgraph/mapping/map_files.h"
#include "sample_map.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using test::TemporaryFolder;

nlohmann::json saved(const std::vector<Landmark>& landmarks, const LandmarksOrigin& origin = {}) {
  const TemporaryFolder folder;
  saveLandmarksJson(landmarks, folder.file("a.json"), origin);
  return nlohmann::json::parse(folder.read("a.json"));
}

TEST(LandmarksJson, HoldsEveryFieldOfALandmark) {
  const auto landmarks = test::sampleMap().landmarks;
  const auto json = saved(landmarks)["landmarks"];
  ASSERT_EQ(json.size(), landmarks.size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    const Landmark& expected = landmarks[i];
    const auto& entry = json[i];
    EXPECT_EQ(entry["id"], expected.id.value);
    EXPECT_EQ(entry["class"], expected.class_name);
    EXPECT_EQ(entry["model"], expected.model);
    EXPECT_EQ(entry["shape"], toString(expected.shape.kind));
    const auto& shape = expected.shape;
    EXPECT_EQ(entry["size_wdh"], nlohmann::json({shape.width, shape.depth, shape.height}));
    EXPECT_EQ(entry["x"], expected.position.x());
    EXPECT_EQ(entry["y"], expected.position.y());
    EXPECT_EQ(entry["z"], expected.position.z());
    EXPECT_EQ(entry["yaw"], expected.yaw);
    EXPECT_EQ(entry["has_yaw"], expected.has_yaw);
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c)
        EXPECT_EQ(entry["covariance"][static_cast<std::size_t>(r)][static_cast<std::size_t>(c)],
                  expected.covariance(r, c));
    EXPECT_EQ(entry["existence"], expected.existence);
    EXPECT_EQ(entry["class_posterior"], nlohmann::json(expected.class_posterior));
    EXPECT_EQ(entry["observations"], expected.observations);
  }
}

TEST(LandmarksJson, SaysSinceWhenWhatWasMovedStandsThere) {
  auto landmarks = test::sampleMap().landmarks;
  landmarks[1].stands_since = 1700000042.5;
  const auto json = saved(landmarks)["landmarks"];
  EXPECT_FALSE(json[0].contains("stands_since"));
  EXPECT_EQ(json[1]["stands_since"], 1700000042.5);
}

TEST(LandmarksJson, HeaderAndSightings) {
  const auto landmarks = test::sampleMap().landmarks;
  ASSERT_GE(landmarks.size(), 2u);
  const LandmarkId seen = landmarks[0].id;
  const auto json = saved(landmarks, {"lab \"a\".rawlog",
                                      "1.2.3",
                                      {{seen, {1700000000.25, 1700000009.125}}},
                                      {{seen, {{"crossed", 0.25}}}}});
  EXPECT_EQ(json["frame"], "world");
  EXPECT_EQ(json["units"], nlohmann::json::parse(R"({"length": "m", "angle": "rad", "time": "s"})"));
  EXPECT_EQ(json["recording"], "lab \"a\".rawlog");
  EXPECT_EQ(json["program"], "roomgraph");
  EXPECT_EQ(json["version"], "1.2.3");
  EXPECT_EQ(json["landmarks"][0]["first_seen"], 1700000000.25);
  EXPECT_EQ(json["landmarks"][0]["last_seen"], 1700000009.125);
  EXPECT_FALSE(json["landmarks"][1].contains("first_seen")) << "not known";
  EXPECT_EQ(json["landmarks"][0]["evidence"], nlohmann::json({{"crossed", 0.25}}));
  EXPECT_FALSE(json["landmarks"][1].contains("evidence")) << "not known";
}

TEST(LandmarksJson, FootprintIsInWorld) {
  Landmark sofa = test::sampleLandmark(3, "sofa", ShapeKind::kCuboid, 10, 20);
  sofa.shape.width = 2;  // along world x after a quarter turn
  sofa.shape.depth = 1;
  sofa.yaw = M_PI / 2;
  double x_min = 1e9, x_max = -1e9, y_min = 1e9, y_max = -1e9;
  const auto json = saved({sofa});
  ASSERT_EQ(json["landmarks"][0]["footprint"].size(), 4u);
  for (const auto& corner : json["landmarks"][0]["footprint"]) {
    const double x = corner[0].get<double>(), y = corner[1].get<double>();
    x_min = std::min(x_min, x), x_max = std::max(x_max, x), y_min = std::min(y_min, y),
    y_max = std::max(y_max, y);
  }
  EXPECT_NEAR(x_min, 9, 1e-9);
  EXPECT_NEAR(x_max, 11, 1e-9);
  EXPECT_NEAR(y_min, 19.5, 1e-9);
  EXPECT_NEAR(y_max, 20.5, 1e-9);
}

TEST(LandmarksJson, EmptyListIsAMapWithoutObjects) {
  const auto json = saved({});
  ASSERT_TRUE(json["landmarks"].is_array());
  EXPECT_TRUE(json["landmarks"].empty());
}

TEST(LandmarksJson, UnwritablePlaceIsARunError) {
  const TemporaryFolder folder;
  EXPECT_THROW(saveLandmarksJson({}, folder.file("missing/a.json")), RunError);
}

}  // namespace
}  // namespace roomgraph
