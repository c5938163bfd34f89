// SPDX-License-Identifier: BSD-3-Clause
// Furniture that is moved during a recording: seen by every sensor where it stands then, and so in the truth.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "color_renderer.h"
#include "errors_of.h"
#include "example_world.h"
#include "id_raster.h"
#include "persistent_detector.h"
#include "roomgraph/core/errors.h"
#include "sensors.h"
#include "temporary_folder.h"
#include "truth_files.h"

namespace roomgraph {
namespace {

using ::testing::HasSubstr;

constexpr double kBefore_s = 0.9, kMoved_s = 1, kAgain_s = 2;

// The block of .6 x .4 m stands at (3.5, .5), is turned by a right angle at (3, -1), and is moved to (4, 1.5), in world.
const std::string kMoves =
    R"("moves": [{"at_s": 1, "at_m": [4, 1], "yaw_deg": 90}, {"at_s": 2, "at_m": [5, 3.5]}], "color": "#000000")";

World movedWorld() {
  return parseWorld(test::changed(R"("color": "#000000")", kMoves), "moved.json");
}

const std::pair<double, Eigen::Vector2d> kPlaces[] = {{0, {3.5, 0.5}}, {kMoved_s, {3, -1}}, {kAgain_s, {4, 1.5}}};

TEST(MovedFurniture, TheLidarMeetsItWhereItStands) {
  const Scene scene(movedWorld());
  const LidarCaster caster(scene, 0.25);
  const auto ahead = [&](double y, double t) { return caster.cast({0, y, 0}, 361, t)[180]; };
  for (const double t : {0.0, kBefore_s}) {
    EXPECT_NEAR(ahead(0.5, t), 3.3, 1e-6) << t;
    EXPECT_NEAR(ahead(-1, t), 5, 1e-6) << t;
  }
  for (const double t : {kMoved_s, 1.9}) {
    EXPECT_NEAR(ahead(0.5, t), 5, 1e-6) << t;
    EXPECT_NEAR(ahead(-1, t), 2.7, 1e-6) << t;  // turned: .6 m along x
  }
  for (const double t : {kAgain_s, 100.0}) EXPECT_NEAR(ahead(1.75, t), 3.8, 1e-6) << t;  // beside somebody who walks
}

TEST(MovedFurniture, ThePictureAndItsTruthShowItWhereItStands) {
  const World world = movedWorld();
  const PinholeCamera& camera = world.camera->model;
  const Scene scene(world);
  ColorRenderer renderer(scene, camera);
  const Pose3 world_from_camera = scene.worldFromCamera(0);
  for (const auto& [t, place] : kPlaces) {
    const auto parts = scene.partPoses(t);
    const IdImage exact = rasterize(scene, parts, world_from_camera, camera);
    const auto block = std::find_if(exact.views.begin(), exact.views.end(), [](const auto& view) { return view.object == 0; });
    ASSERT_NE(block, exact.views.end()) << t;
    const Eigen::Vector2d middle = camera.project(world_from_camera.inverse() * Eigen::Vector3d(place.x(), place.y(), 0.5));
    EXPECT_TRUE(block->box.contains(cv::Point(static_cast<int>(middle.x()), static_cast<int>(middle.y())))) << t;
    const cv::Mat rendered = renderer.renderDepth(parts, world_from_camera, 1);
    int different = 0;
    for (int v = 0; v < rendered.rows; ++v)
      for (int u = 0; u < rendered.cols; ++u)
        different += std::abs(rendered.at<float>(v, u) - exact.depth.at<float>(v, u)) > 0.02f;
    EXPECT_LT(different, static_cast<int>(rendered.total()) / 100) << t;
  }
}

// From the first instant on somewhere else: there for all.
TEST(MovedFurniture, WhatIsMovedAtOnceWasNeverAtItsFirstPlace) {
  const Scene scene(parseWorld(test::changed(R"("color": "#000000")", R"("moves": [{"at_s": 0, "at_m": [4, 1]}, {"at_s": 2, "at_m": [5, 3.5]}])"), "w.json"));
  const LidarCaster caster(scene, 0.25);
  EXPECT_NEAR(caster.cast({0, -1, 0}, 361, 0)[180], 2.8, 1e-6);
  EXPECT_NEAR(caster.cast({0, 1.75, 0}, 361, 2)[180], 3.8, 1e-6);
}

// Errors of the detector depend on the side from which it sees an object.
TEST(MovedFurniture, ThePersistentDetectorKnowsWhereItStands) {
  World world = movedWorld();
  world.detections = DetectionsSpec{.persistent = true};
  World other = world;
  other.furniture[0].at_m = {4, 1, 0};
  other.furniture[0].yaw_rad = M_PI / 2;
  other.furniture[0].moves.clear();
  const Scene moved(world), standing(other);
  const Pose3 from = moved.worldFromCamera(0);
  const IdImage image = rasterize(moved, moved.partPoses(kMoved_s), from, world.camera->model);
  int found = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    PersistentDetector a(moved, world.camera->model, *world.detections, seed), b(standing, other.camera->model, *other.detections, seed);
    const auto seen = a.detect(image, from, kMoved_s, 0).items, expected = b.detect(image, from, kMoved_s, 0).items;
    ASSERT_EQ(seen.size(), expected.size()) << seed;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      EXPECT_EQ(seen[i].label, expected[i].label) << seed;
      EXPECT_EQ(seen[i].u_min, expected[i].u_min) << seed;
    }
    found += static_cast<int>(seen.size());
  }
  EXPECT_GT(found, 10);
}

TEST(MovedFurniture, TheTruthIsItsPlaceAtTheEndAndTellsTheOthers) {
  const test::TemporaryFolder folder;
  const Scene scene(movedWorld());
  for (std::size_t count = 1; count <= 3; ++count) {
    writeObjects(folder.file("objects.json"), scene, kPlaces[count - 1].first);
    const auto block = nlohmann::json::parse(folder.read("objects.json"))["objects"][0];
    const auto& place = kPlaces[count - 1].second;
    EXPECT_NEAR(block["x"].get<double>(), place.x(), 1e-4);
    EXPECT_NEAR(block["y"].get<double>(), place.y(), 1e-4);
    EXPECT_NEAR(block["yaw"].get<double>(), count == 2 ? 1.5708 : 0, 1e-4);
    ASSERT_EQ(block["places"].size(), count);
    EXPECT_EQ(block["places"][count - 1]["since_s"], kPlaces[count - 1].first);
    EXPECT_NEAR(block["places"][0]["x"].get<double>(), 3.5, 1e-4);
    Eigen::AlignedBox2d box;
    for (const auto& corner : block["footprint"])
      box.extend(Eigen::Vector2d(corner[0].get<double>(), corner[1].get<double>()));
    EXPECT_LT((box.center() - place).norm(), 1e-4);
    EXPECT_NEAR(box.sizes().x(), count == 2 ? 0.6 : 0.4, 2e-4);
  }
}

TEST(MovedFurniture, TheTrueMapHasItWhereItStandsThen) {
  const Scene scene(movedWorld());
  const LidarCaster caster(scene, 0.25);
  for (const auto& [t, place] : kPlaces) {
    int around = 0, people = 0;
    for (const auto& segment : caster.furnishedOutlines(t)) {
      const Eigen::Vector2d middle = (segment.a + segment.b) / 2;
      around += (middle - place).norm() < 0.4;
      people += std::abs(middle.y() - 1.4) < 0.3 && middle.x() < 2.5;
    }
    EXPECT_GE(around, 4) << t;
    EXPECT_EQ(people, 0) << t;
  }
}

std::string parseError(const std::string& moves) {
  return test::messageOf<ConfigError>([&] { parseWorld(test::changed(R"("color": "#000000")", moves), "moved.json"); });
}

TEST(MovedFurniture, WhatCannotBeIsRefusedByItsPlaceInTheFile) {
  EXPECT_THAT(parseError(R"("moves": [{"at_s": 2, "at_m": [4, 1]}, {"at_s": 2, "at_m": [5, 1]}])"),
              HasSubstr("furniture[0].moves[1].at_s: must come after the move before it"));
  EXPECT_THAT(parseError(R"("moves": [{"at_s": 2, "at_m": [4, 0]}])"), HasSubstr("furniture[0].moves[0]: the block stands in a wall"));
  // The robot is at x = 2.3 m after 3.4 s, and has not been there after 1 s.
  EXPECT_THAT(parseError(R"("moves": [{"at_s": 1, "at_m": [2.3, 2]}])"),
              HasSubstr("the path goes through furniture[0].moves[0] (block)"));
  EXPECT_NO_THROW(parseWorld(test::changed(R"("color": "#000000")", R"("moves": [{"at_s": 60, "at_m": [2.3, 2]}])"), "w.json"));
  EXPECT_THAT(parseError(R"("moves": [{"at_s": 60, "at_m": [3, 2]}])"), HasSubstr("the path goes through furniture[0].moves[0] (block)"))
      << "it rests there";
  EXPECT_NO_THROW(parseWorld(test::changed(R"("at_m": [4.5, 2.5],)", R"("at_m": [2.9, 2], "moves": [{"at_s": 1, "at_m": [4, 1]}],)"), "w.json"));
}

}  // namespace
}  // namespace roomgraph
