// SPDX-License-Identifier: BSD-3-Clause
// Scene of a map: extent, grid, floor, walls, path and objects against the map; view and overlay in pixels.
#include <gtest/gtest.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/CTexturedPlane.h>

#include <algorithm>
#include <map>

#include "overlay.h"
#include "picture_legend.h"
#include "roomgraph/rendering/palette.h"
#include "roomgraph/rendering/scene_parts.h"
#include "sample_map.h"
#include "scene.h"

namespace roomgraph {
namespace {

using test::sampleMap;

const ObjectDatabase& colours() {
  static const ObjectDatabase objects = ObjectDatabase::fromText(
      "[swivel_chair]\nlabels=chair\ncolor=#e6862a\n[sofa]\nlabels=couch\ncolor=#3f7fd0\n"
      "[door]\nlabels=door\ncolor=#3aa657\n");
  return objects;
}

/// Largest difference of the channels.
int apart(const cv::Vec3b& bgr, const palette::TColor& color) {
  return std::max({std::abs(bgr[0] - color.B), std::abs(bgr[1] - color.G), std::abs(bgr[2] - color.R)});
}

std::vector<mrpt::opengl::TTriangle> trianglesOf(const CSemanticMap& map, const std::string& name) {
  const auto scene = buildScene(map, colours());
  const auto set = std::dynamic_pointer_cast<mrpt::opengl::CSetOfTriangles>(scene->getByName(name));
  std::vector<mrpt::opengl::TTriangle> out(set ? set->getTrianglesCount() : 0);
  for (std::size_t i = 0; i < out.size(); ++i) set->getTriangle(i, out[i]);
  return out;
}

Eigen::Vector3d corner(const mrpt::opengl::TTriangle& t, std::size_t i) {
  return {static_cast<double>(t.x(i)), static_cast<double>(t.y(i)), static_cast<double>(t.z(i))};
}

Eigen::AlignedBox3d boundsOf(const std::vector<mrpt::opengl::TTriangle>& triangles) {
  Eigen::AlignedBox3d box;
  for (const auto& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) box.extend(corner(t, i));
  return box;
}

TEST(MapScene, TheContentIsCellsObjectsAndPath) {
  CSemanticMap map = sampleMap();
  const auto box = contentBounds(map);
  EXPECT_LT((box.min() - Eigen::Vector3d(-0.975, -1.975, 0)).norm(), 1e-5) << "centres of the outermost cells";
  EXPECT_LT((box.max() - Eigen::Vector3d(4.975, 1.975, 0.91)).norm(), 1e-5);
  EXPECT_NEAR(contentExtent(map), 5.95, 1e-5);
  map.world_from_robot.push_back({2000, poseFromYpr(9, 0, 0, 0, 0, 0)});
  EXPECT_NEAR(contentBounds(map).max().x(), 9, 1e-9);
  map.occupancy->fill(0.5f);
  EXPECT_GT(contentBounds(map).min().x(), -0.1) << "unknown cells are nothing to show";
  const auto nothing = contentBounds(CSemanticMap());
  EXPECT_LT((nothing.min().head<2>() - Eigen::Vector2d(-1, -1)).norm(), 1e-9);
  EXPECT_LT((nothing.max().head<2>() - Eigen::Vector2d(1, 1)).norm(), 1e-9);
}

TEST(MapScene, GridStepsAreTheNextRoundNumber) {
  for (double extent = 0.5; extent < 5000; extent *= 1.13) {
    double expected = 0;
    for (double power = 1; expected == 0; power *= 10)
      for (const double digit : {1, 2, 5})
        if (expected == 0 && digit * power * 12 >= extent) expected = digit * power;
    EXPECT_EQ(gridStep(extent), expected) << extent;
  }
}

TEST(MapScene, GridLinesAreRoundCoordinates) {
  const auto lines = trianglesOf(sampleMap(), "metre grid");
  const auto box = boundsOf(lines);
  EXPECT_NEAR(box.min().x(), -1, 0.02);
  EXPECT_NEAR(box.max().x(), 5, 0.02);
  EXPECT_NEAR(box.min().y(), -2, 0.02);
  EXPECT_NEAR(box.max().y(), 2, 0.02);
  EXPECT_EQ(lines.size(), 2u * (7 + 5)) << "x = -1 … 5 and y = -2 … 2";
}

TEST(MapScene, WallsHaveTheSurfaceOfTheOccupiedCells) {
  const auto area = [](const CSemanticMap& map) {
    double sum = 0;
    for (const auto& t : trianglesOf(map, "walls"))
      sum += (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm() / 2;
    return sum;
  };
  // Two cells thick around 6 x 4 m: top 24 - 5.8 * 3.8, sides 2 (6 + 4) + 2 (5.8 + 3.8) of 0.35 m.
  CSemanticMap map = sampleMap();
  EXPECT_NEAR(area(map), 24 - 5.8 * 3.8 + (20 + 19.2) * 0.35, 1e-3);
  map.occupancy->fill(0.9f);
  map.occupancy->setCell(30, 40, 0.01f);
  map.occupancy->setCell(31, 40, 0.01f);
  EXPECT_NEAR(area(map), 2 * 0.0025 + 6 * 0.05 * 0.35, 1e-5) << "none between two cells";
  const auto box = boundsOf(trianglesOf(map, "walls"));
  EXPECT_LT((box.min() - Eigen::Vector3d(0.5, 0, 0)).norm(), 1e-5);
  EXPECT_LT((box.max() - Eigen::Vector3d(0.6, 0.05, 0.35)).norm(), 1e-5);
}

TEST(MapScene, TheFloorShowsTheGridWithItsLowestRowFirst) {
  CSemanticMap map = sampleMap();
  map.occupancy->fill(0.5f);
  map.occupancy->setCell(10, 3, 0.01f);
  map.occupancy->setCell(20, 70, 0.99f);
  const auto scene = buildScene(map, colours());
  const auto plane = std::dynamic_pointer_cast<mrpt::opengl::CTexturedPlane>(scene->getByName("floor"));
  ASSERT_TRUE(plane);
  const cv::Mat image = plane->getTextureImage().asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
  ASSERT_EQ(image.size(), cv::Size(120, 80));
  const auto is = [&](int x, int y, const palette::TColor& color) {
    return apart(image.at<cv::Vec3b>(y, x), color) < 4;
  };
  EXPECT_TRUE(is(10, 3, palette::kOccupied));
  EXPECT_TRUE(is(20, 70, palette::kFree));
  EXPECT_TRUE(is(10, 4, palette::kUnknown));
}

TEST(MapScene, ThePathLiesOnTheFloorUnlessTheMapIsNotPlanar) {
  CSemanticMap map = sampleMap();
  for (auto& stamped : map.world_from_robot) stamped.pose.translation().z() = 1.2;
  map.planar = true;
  EXPECT_LT(boundsOf(trianglesOf(map, "path")).max().z(), 0.1);
  map.planar = false;
  const auto path = trianglesOf(map, "path");
  EXPECT_GT(boundsOf(path).min().z(), 1.2);
  // From light to dark: ribbons near the start are lighter than those near the end.
  const auto shadeAt = [&](double x) {
    for (const auto& t : path)
      if (std::abs(corner(t, 0).x() - x) < 0.06) return static_cast<int>(t.vertices[0].xyzrgba.g);
    return -1;
  };
  EXPECT_GT(shadeAt(0.7), shadeAt(2.0) + 20);
  map.world_from_robot.clear();
  EXPECT_TRUE(trianglesOf(map, "path").empty());
}

TEST(MapScene, ObjectsFillTheirFootprintAndPointToTheirFront) {
  const CSemanticMap map = sampleMap();
  for (const auto& landmark : map.landmarks) {
    const auto triangles = trianglesOf(map, landmark.class_name + " " + std::to_string(landmark.id.value));
    ASSERT_FALSE(triangles.empty());
    const Pose3 to_object = landmark.worldFromObject().inverse();
    Eigen::AlignedBox3d box;
    for (const auto& t : triangles)
      for (std::size_t i = 0; i < 3; ++i) box.extend(Eigen::Vector3d(to_object * corner(t, i)));
    EXPECT_NEAR(box.max().y(), landmark.shape.width / 2, 0.03) << landmark.class_name;
    EXPECT_NEAR(box.min().y(), -landmark.shape.width / 2, 0.03);
    EXPECT_NEAR(box.min().x(), -landmark.shape.depth / 2, 0.03);
    EXPECT_NEAR(box.sizes().z(), landmark.shape.height, 0.03);
    EXPECT_EQ(box.max().x() > landmark.shape.depth / 2 + 0.1, landmark.has_yaw) << "arrow at the front";
    const auto color = palette::ofClass(colours(), landmark.class_name);
    EXPECT_TRUE(std::any_of(triangles.begin(), triangles.end(), [&](const auto& t) {
      const auto& c = t.vertices[0].xyzrgba;
      return c.r == color.R && c.g == color.G && c.b == color.B;
    }));
  }
}

TEST(SceneView, TheTopViewIsToScaleWithYUpwards) {
  const CSemanticMap map = sampleMap();
  const auto scene = buildScene(map, colours());
  const SnapshotOptions options{SnapshotView::kTop, 800, 600, ""};
  const SceneView view(*scene, map, options, mapArea(options));
  ASSERT_TRUE(view.orthographic());
  const Eigen::Vector2d origin = *view.project({0, 0, 0}), x = *view.project({1, 0, 0}), y = *view.project({0, 1, 0});
  EXPECT_NEAR(x.x() - origin.x(), view.pixelsPerMeter(), 1e-3);
  EXPECT_NEAR(x.y(), origin.y(), 1e-3);
  EXPECT_NEAR(origin.y() - y.y(), view.pixelsPerMeter(), 1e-3);
  EXPECT_NEAR((*view.project({2, 1, 3}) - *view.project({2, 1, 0})).norm(), 0, 1e-3) << "heights do not shift";
}

TEST(SceneView, TheContentFillsTheMapArea) {
  const CSemanticMap map = sampleMap();
  for (const auto& [view, width, height] :
       {std::tuple{SnapshotView::kTop, 800, 600}, {SnapshotView::kTop, 400, 900}, {SnapshotView::kOrbit, 800, 600}}) {
    const SnapshotOptions options{view, width, height, "title"};
    const auto scene = buildScene(map, colours());
    const Box2 area = mapArea(options);
    const SceneView camera(*scene, map, options, area);
    Eigen::AlignedBox2d image;
    const auto box = contentBounds(map);
    for (const double x : {box.min().x(), box.max().x()})
      for (const double y : {box.min().y(), box.max().y()}) image.extend(*camera.project({x, y, 0}));
    EXPECT_GT(image.min().x(), area.u_min - 2);
    EXPECT_LT(image.max().x(), area.u_max + 2);
    EXPECT_GT(image.min().y(), area.v_min - 2);
    EXPECT_LT(image.max().y(), area.v_max + 2);
    EXPECT_GT(std::max(image.sizes().x() / area.width(), image.sizes().y() / area.height()), 0.95);
  }
}

TEST(SceneView, TheRobotsViewLooksAheadFromBehind) {
  const CSemanticMap map = sampleMap();
  const SnapshotOptions options{SnapshotView::kRobot, 800, 600, ""};
  const auto scene = buildScene(map, colours());
  const SceneView view(*scene, map, options, mapArea(options));
  const Pose3& robot = map.world_from_robot.back().pose;
  const auto pixel = [&](double forward, double left) { return *view.project(robot * Eigen::Vector3d(forward, left, 0)); };
  EXPECT_NEAR(pixel(0, 0).x(), 400, 1) << "in the middle";
  EXPECT_LT(pixel(2, 0).y(), pixel(0, 0).y()) << "ahead is up";
  EXPECT_LT(pixel(1, 1).x(), 390) << "left is left";
  EXPECT_GT((pixel(0, 1) - pixel(0, -1)).norm(), (pixel(3, 1) - pixel(3, -1)).norm()) << "farther is smaller";
  EXPECT_FALSE(view.project(robot * Eigen::Vector3d(-20, 0, 0))) << "behind the camera";
}

TEST(Overlay, TheScaleBarIsAsLongAsItSays) {
  CSemanticMap map = sampleMap();
  map.landmarks.clear();
  const SnapshotOptions options{SnapshotView::kTop, 800, 600, ""};
  const auto scene = buildScene(map, colours());
  const SceneView view(*scene, map, options, mapArea(options));
  cv::Mat image(600, 800, CV_8UC3, cv::Scalar(255, 255, 255));
  drawOverlay(image, map, colours(), options, view);
  // The bar: the lowest row with dark pixels in the right half.
  int first = 800, last = 0;
  const int row = static_cast<int>(600 - 2.6 * 600 / 96.0);
  for (int u = 500; u < 800; ++u)
    if (image.at<cv::Vec3b>(row, u)[1] < 128) {
      first = std::min(first, u);
      last = u;
    }
  EXPECT_NEAR(last + 1 - first, 1 * view.pixelsPerMeter(), 2) << "the grid's step, 1 m";
}

TEST(Overlay, TheLegendHasTheClassesColours) {
  CSemanticMap map = sampleMap();
  map.landmarks.resize(2);  // the legend is sorted by name
  map.landmarks[0].class_name = "sofa";
  map.landmarks[1].class_name = "door";
  const SnapshotOptions options{SnapshotView::kTop, 960, 960, ""};  // unit: 10 px
  const auto scene = buildScene(map, colours());
  const SceneView view(*scene, map, options, mapArea(options));
  cv::Mat image(960, 960, CV_8UC3, cv::Scalar(255, 255, 255));
  drawOverlay(image, map, colours(), options, view);
  const auto swatch = image.at<cv::Vec3b>(960 - 26 - 5, 30 + 6);
  const auto expected = palette::mix(palette::ofClass(colours(), "door"), palette::kFree, 0.25);
  EXPECT_LT(apart(swatch, expected), 4);
}

CSemanticMap mapOfManyKinds(std::size_t count) {
  CSemanticMap map = sampleMap();
  map.landmarks.resize(1);
  for (std::size_t i = 0; i < count; ++i) {
    map.landmarks.push_back(map.landmarks[0]);
    map.landmarks.back().class_name = "kind of object " + std::to_string(10 + i);
  }
  map.landmarks.erase(map.landmarks.begin());
  return map;
}

TEST(Overlay, ALegendOfManyClassesTakesRowsBesideTheScale) {
  const CSemanticMap map = mapOfManyKinds(12);
  const SnapshotOptions options{SnapshotView::kTop, 960, 960, ""};  // unit: 10 px
  const PictureLegend legend(map, colours(), {960, 960}, 10);
  ASSERT_GE(legend.entries.size(), 12u);
  ASSERT_GT(legend.rows(), 1u);
  const Box2 area = mapArea(map, colours(), options);
  EXPECT_EQ(area.v_max, 960 - 60 - 24.0 * static_cast<double>(legend.rows() - 1));
  const auto scene = buildScene(map, colours());
  const double bar_from = 960 - 30 - SceneView(*scene, map, options, area).pixelsPerMeter() * gridStep(contentExtent(map));
  std::map<std::size_t, double> end;
  for (const auto& entry : legend.entries) {
    EXPECT_GE(entry.u, end[entry.row]) << entry.text;
    end[entry.row] = entry.u + 13 + 7 + textWidth(entry.text, {9});
    EXPECT_LT(end[entry.row], bar_from) << entry.text;
  }
  EXPECT_EQ(end.size(), legend.rows());
}

TEST(Overlay, ALegendIsNoLargerThanHalfThePicture) {
  const CSemanticMap map = mapOfManyKinds(90);
  const std::size_t all = PictureLegend(map, colours(), {9000, 9000}, 6).entries.size();
  const PictureLegend legend(map, colours(), {320, 240}, 6);
  EXPECT_LE(6 * kLegendRow * static_cast<double>(legend.rows()), 120);
  EXPECT_GT(legend.rows(), 4u);
  EXPECT_EQ(legend.entries.back().text, "and " + std::to_string(all - (legend.entries.size() - 1)) + " more");
}

TEST(Overlay, ATitleTakesItsPlaceFromTheMap) {
  const Box2 bare = mapArea({SnapshotView::kTop, 960, 1200, ""}), titled = mapArea({SnapshotView::kTop, 960, 1200, "t"});
  EXPECT_EQ(bare.v_min, 30);
  EXPECT_EQ(titled.v_min, 80);
  EXPECT_EQ(titled.v_max, 1200 - 60);
  EXPECT_EQ(titled.u_max, 960 - 30);
}

}  // namespace
}  // namespace roomgraph
