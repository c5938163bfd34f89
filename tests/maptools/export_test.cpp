// SPDX-License-Identifier: BSD-3-Clause
// Every export, read back by a program that is not ours.
#include <gmock/gmock.h>
#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <yaml-cpp/yaml.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/maptools/map_export.h"
#include "roomgraph/rendering/scene_file.h"
#include "sample_map.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using test::TemporaryFolder;

ObjectDatabase twoClasses() {
  return ObjectDatabase::fromText(
      "[sofa]\nlabels = sofa\ncolor = #3f7fd0\n[swivel_chair]\nlabels = chair\ncolor = #e6862a\n");
}

/// Names that each format has to quote.
CSemanticMap awkwardMap() {
  CSemanticMap map = test::sampleMap();
  map.landmarks[1].model = "a \"large\", red <sofa> & more";
  map.landmarks.push_back(test::sampleLandmark(12, "tv, \"flat\"", ShapeKind::kCuboid, 0.2, -1.1));
  return map;
}

TEST(MapExport, PythonReadsTextFormatsBack) {
  const TemporaryFolder folder;
  const CSemanticMap map = awkwardMap();
  for (const auto& format : exportFormats())
    exportMap(map, twoClasses(), format, folder.path(), {{}, 0.1, 25});
  saveLandmarksJson(map.landmarks, folder.file("landmarks.json"));
  const std::string command = std::string(ROOMGRAPH_PYTHON) + " " + ROOMGRAPH_SOURCE_DIR +
                              "/tests/maptools/read_exports.py " + folder.path().string() + " " +
                              folder.file("landmarks.json").string() + " 25 > " +
                              folder.file("said").string() + " 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << folder.read("said");
}

/// Whether a point is on a landmark, from its corners by the sides that it lies on: footprints are convex.
double insideBy(const Landmark& landmark, const Eigen::Vector2d& point) {
  const auto corners =
      footprintAt({landmark.position.x(), landmark.position.y(), landmark.yaw}, landmark.shape);
  double least = 1e9;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d along = (corners[(i + 1) % corners.size()] - corners[i]).normalized(),
                          to = point - corners[i];
    least = std::min(least, along.x() * to.y() - along.y() * to.x());
  }
  return least;
}

struct ImageOnMap {
  cv::Mat image;
  double x_min, y_min, cell;
  Eigen::Vector2d centre(int row, int column) const {
    return {x_min + (column + 0.5) * cell, y_min + (image.rows - row - 0.5) * cell};
  }
};

ImageOnMap readLayer(const TemporaryFolder& folder, const std::string& name, const std::string& mode) {
  const YAML::Node yaml = YAML::LoadFile(folder.file(name).string());
  EXPECT_EQ(yaml["mode"].as<std::string>(), mode);
  const cv::Mat image =
      cv::imread(folder.file(yaml["image"].as<std::string>()).string(), cv::IMREAD_GRAYSCALE);
  return {image, yaml["origin"][0].as<double>(), yaml["origin"][1].as<double>(),
          yaml["resolution"].as<double>()};
}

TEST(MapExport, SemanticLayerNumbersClassesOnTheirFootprints) {
  const TemporaryFolder folder;
  const CSemanticMap map = test::sampleMap();
  exportMap(map, twoClasses(), "semantic", folder.path());
  const auto legend = nlohmann::json::parse(folder.read("semantic_legend.json"));
  std::map<int, std::string> names;
  for (const auto& entry : legend["classes"])
    names[entry["value"]] = entry["class"].is_null() ? "" : entry["class"].get<std::string>();
  EXPECT_EQ(names.size(), 4u);
  EXPECT_EQ(legend["classes"][2]["color"], "#3f7fd0");
  const ImageOnMap layer = readLayer(folder, "semantic.yaml", "raw");
  ASSERT_EQ(layer.image.cols, 120);
  ASSERT_EQ(layer.image.rows, 80);
  for (int row = 0; row < 80; ++row)
    for (int column = 0; column < 120; ++column) {
      std::string expected;
      bool border = false;
      for (const auto& landmark : map.landmarks) {
        const double inside = insideBy(landmark, layer.centre(row, column));
        if (inside > 0) expected = landmark.class_name;
        border = border || std::abs(inside) < 1e-5;
      }
      if (border) continue;
      ASSERT_EQ(names.at(layer.image.at<unsigned char>(row, column)), expected) << row << " " << column;
    }
}

TEST(MapExport, LikelierObjectIsOnTop) {
  const TemporaryFolder folder;
  CSemanticMap map = test::sampleMap();
  map.landmarks[2].position = map.landmarks[1].position;
  map.landmarks[2].shape = {ShapeKind::kCuboid, 3, 2, 1};
  for (const bool first : {true, false}) {
    map.landmarks[1].existence = first ? 0.9 : 0.5;
    map.landmarks[2].existence = 0.7;
    exportMap(map, twoClasses(), "semantic", folder.path());
    const ImageOnMap layer = readLayer(folder, "semantic.yaml", "raw");
    // The sofa's place (3.6, -1): class 2 of door, sofa, swivel_chair.
    EXPECT_EQ(layer.image.at<unsigned char>(80 - 1 - 20, 92), first ? 2 : 1);
  }
}

TEST(MapExport, KeepoutKeepsItsDistanceByClass) {
  const TemporaryFolder folder;
  const CSemanticMap map = test::sampleMap();
  exportMap(map, twoClasses(), "keepout", folder.path(), {{{"sofa", 0.4}}, 0.15, 50});
  const ImageOnMap layer = readLayer(folder, "keepout.yaml", "scale");
  double farthest_sofa = 0, farthest_chair = 0;
  int kept_out = 0;
  for (int row = 0; row < layer.image.rows; ++row)
    for (int column = 0; column < layer.image.cols; ++column) {
      if (layer.image.at<unsigned char>(row, column) != 0) continue;
      ++kept_out;
      const auto at = layer.centre(row, column);
      const double sofa = -insideBy(map.landmarks[1], at), chair = -insideBy(map.landmarks[0], at);
      EXPECT_TRUE(sofa < 0.4 + 1e-6 || chair < 0.16) << at.transpose();
      if (at.x() > 2.4)
        farthest_sofa = std::max(farthest_sofa, sofa);
      else
        farthest_chair = std::max(farthest_chair, chair);
    }
  EXPECT_GT(farthest_sofa, 0.34);
  EXPECT_GT(farthest_chair, 0.09);
  // Areas: rectangle with rounded margin, circle; the door is left out.
  const double expected = 0.7 * 0.5 + 2 * 1.2 * 0.4 + 3.1416 * 0.16 + 3.1416 * 0.5 * 0.5;
  EXPECT_NEAR(kept_out * 0.0025, expected, 0.06);
}

TEST(MapExport, MrptReadsMeshAndScene) {
  const TemporaryFolder folder;
  const CSemanticMap map = test::sampleMap();
  exportMap(map, twoClasses(), "ply", folder.path());
  mrpt::maps::CColouredPointsMap points;
  ASSERT_TRUE(points.loadFromPlyFile(folder.file("map.ply").string()));
  mrpt::math::TBoundingBoxf box = points.boundingBox();
  EXPECT_NEAR(box.min.x, -1, 1e-3);
  EXPECT_NEAR(box.max.x, 5, 1e-3);
  EXPECT_NEAR(box.max.y, 2, 1e-3);
  EXPECT_NEAR(box.max.z, 1, 1e-3) << "walls are 1 m high";
  saveScene(map, twoClasses(), folder.file("map.3Dscene"));
  mrpt::opengl::COpenGLScene scene;
  ASSERT_TRUE(scene.loadFromFile(folder.file("map.3Dscene").string()));
  EXPECT_TRUE(scene.getByName("path"));
  EXPECT_EQ(folder.count(), 2u);
}

TEST(MapExport, PathIsNotDrawnBetweenSessions) {
  const TemporaryFolder folder;
  CSemanticMap map = test::sampleMap();
  const auto lines = [&] {
    exportMap(map, twoClasses(), "dxf", folder.path());
    const std::string text = folder.read("plan.dxf");
    int count = 0;
    for (auto at = text.find("POLYLINE\n8\nPATH"); at != std::string::npos;
         at = text.find("POLYLINE\n8\nPATH", at + 1))
      ++count;
    return count;
  };
  EXPECT_EQ(lines(), 1);
  for (std::size_t i = 20; i < map.world_from_robot.size(); ++i)
    map.world_from_robot[i].pose.translation().y() += 1.2;
  EXPECT_EQ(lines(), 2);
}

TEST(MapExport, MapWithoutGridOrWithoutAnything) {
  const TemporaryFolder folder;
  CSemanticMap map = test::sampleMap();
  map.occupancy.reset();
  for (const auto& format : exportFormats())
    EXPECT_NO_THROW(exportMap(map, twoClasses(), format, folder.path())) << format;
  for (const std::string format : {"nav2", "semantic", "keepout", "svg", "dxf", "ply"})
    EXPECT_THAT(test::messageOf<RunError>([&] { exportMap({}, twoClasses(), format, folder.path()); }),
                ::testing::HasSubstr("empty"))
        << format;
  EXPECT_THAT(test::messageOf<RunError>([&] { exportMap(map, twoClasses(), "obj", folder.path()); }),
              ::testing::HasSubstr("unknown format 'obj'; known: nav2"));
  EXPECT_THROW(exportMap(map, twoClasses(), "csv", folder.file("missing")), RunError);
}

}  // namespace
}  // namespace roomgraph
