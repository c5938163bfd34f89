// SPDX-License-Identifier: BSD-3-Clause
// Snapshots of a sample map in every view; saved OpenGL scene.
#include "roomgraph/rendering/snapshot.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "overlay.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/rendering/palette.h"
#include "sample_map.h"
#include "scene.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using test::TemporaryFolder;

ObjectDatabase database() {
  return ObjectDatabase::fromText(
      "[swivel_chair]\nlabels=chair\ncolor=#e6862a\n[sofa]\nlabels=couch\ncolor=#3f7fd0\n"
      "[door]\nlabels=door\ncolor=#3aa657\n");
}

cv::Mat snapshot(const CSemanticMap& map, const SnapshotOptions& options) {
  const TemporaryFolder folder;
  renderSnapshot(map, database(), options, folder.file("x.png"));
  return cv::imread(folder.file("x.png").string());
}

/// Largest difference of the channels.
int difference(const cv::Vec3b& bgr, const palette::TColor& color) {
  return std::max({std::abs(bgr[0] - color.B), std::abs(bgr[1] - color.G), std::abs(bgr[2] - color.R)});
}

TEST(Snapshot, EveryViewHasTheSizeAskedForAndShowsTheObjects) {
  for (const auto view : {SnapshotView::kTop, SnapshotView::kOrbit, SnapshotView::kRobot}) {
    const cv::Mat image = snapshot(test::sampleMap(), {view, 400, 300, "A title"});
    ASSERT_EQ(image.size(), cv::Size(400, 300));
    int unlike_background = 0, dark = 0;
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        unlike_background += difference(image.at<cv::Vec3b>(v, u), palette::kUnknown) > 8;
        dark += difference(image.at<cv::Vec3b>(v, u), palette::kOccupied) < 12;
      }
    }
    EXPECT_GT(unlike_background, 400 * 300 / 8);
    EXPECT_GT(dark, 60) << "no walls";
  }
}

TEST(Snapshot, ObjectsHaveTheirClassColourWhereTheyAre) {
  const CSemanticMap map = test::sampleMap();
  for (const auto& [width, height] : {std::pair{800, 600}, {500, 700}}) {
    const SnapshotOptions options{SnapshotView::kTop, width, height, ""};
    const cv::Mat image = snapshot(map, options);
    const auto scene = buildScene(map, database());
    const SceneView view(*scene, map, options, mapArea(options));
    for (const auto& landmark : map.landmarks) {
      const auto pixel = view.project(landmark.position);
      ASSERT_TRUE(pixel);
      const auto color = image.at<cv::Vec3b>(static_cast<int>(pixel->y()), static_cast<int>(pixel->x()));
      // Translucent over the white floor.
      const auto expected =
          palette::mix(palette::ofClass(database(), landmark.class_name), palette::kFree, 0.25);
      EXPECT_LT(difference(color, expected), 30) << landmark.class_name << " at " << pixel->transpose();
    }
    // Independent of the camera model: the room's middle is at the picture's map area's middle.
    EXPECT_NEAR((*view.project({2, 0, 0}) - mapArea(options).center()).norm(), 0, 2);
  }
}

TEST(Snapshot, WorksWithoutOccupancyObjectsOrPath) {
  CSemanticMap map = test::sampleMap();
  map.occupancy.reset();
  EXPECT_FALSE(snapshot(map, {SnapshotView::kTop, 320, 240, ""}).empty());
  map.landmarks.clear();
  EXPECT_FALSE(snapshot(map, {SnapshotView::kOrbit, 320, 240, ""}).empty());
  EXPECT_FALSE(snapshot(CSemanticMap(), {SnapshotView::kRobot, 320, 240, "empty"}).empty());
}

TEST(Snapshot, AnyWidthIsFine) {
  for (const int width : {201, 202, 203})
    EXPECT_EQ(snapshot(test::sampleMap(), {SnapshotView::kTop, width, 151, ""}).size(), cv::Size(width, 151));
}

TEST(Snapshot, UnwritablePlaceIsARunError) {
  const TemporaryFolder folder;
  EXPECT_THROW(renderSnapshot(test::sampleMap(), database(), {SnapshotView::kTop, 320, 240, ""},
                              folder.file("missing/x.png")),
               RunError);
}

TEST(Scene, HasAnObjectPerLandmarkAndCanBeSaved) {
  const TemporaryFolder folder;
  const auto scene = buildScene(test::sampleMap(), database());
  for (const char* name : {"floor", "walls", "path", "swivel_chair 1", "sofa 2", "door 7"})
    EXPECT_TRUE(scene->getByName(name)) << name;
  ASSERT_TRUE(scene->saveToFile(folder.file("x.3Dscene").string()));
  EXPECT_GT(std::filesystem::file_size(folder.file("x.3Dscene")), 1000u);
}

}  // namespace
}  // namespace roomgraph
