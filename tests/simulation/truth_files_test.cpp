// SPDX-License-Identifier: BSD-3-Clause
// Truth files read back: poses, boxes, objects, calibration and the occupancy map of a room by hand.
#include "truth_files.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "example_world.h"
#include "roomgraph/core/random.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using nlohmann::json;

TEST(TruthFiles, APoseIsTimePlaceAndQuaternion) {
  const test::TemporaryFolder folder;
  const Pose3 pose = poseFromYpr(1.5, -2.25, 0.75, 0.6, -0.3, 0.2);
  TruthFile file(folder.file("poses.txt"));
  writePose(file, 1700000000.125, pose);
  file.finish();
  std::istringstream in(folder.read("poses.txt"));
  double t = 0;
  Eigen::Vector3d p;
  Eigen::Quaterniond q;
  in >> t >> p.x() >> p.y() >> p.z() >> q.x() >> q.y() >> q.z() >> q.w();
  ASSERT_TRUE(in);
  EXPECT_EQ(t, 1700000000.125);
  EXPECT_LT((p - pose.translation()).norm(), 1e-6);
  EXPECT_LT((q.toRotationMatrix() - pose.linear()).norm(), 1e-6);
}

TEST(TruthFiles, BoxesNameTheObjectsAndTheirVisibility) {
  const test::TemporaryFolder folder;
  const Scene scene(test::exampleWorld());
  TruthFile file(folder.file("boxes.jsonl"));
  const ObjectView view{1, 345, {10, 20, 30, 40}, {-5, 20, 45, 60}, 0.25, 0.5, 0.75, 2.125};
  writeBoxes(file, 7, 12.5, {view}, scene);
  writeBoxes(file, 8, 12.6, {}, scene);
  file.finish();
  std::istringstream in(folder.read("boxes.jsonl"));
  std::string first, second;
  std::getline(in, first);
  std::getline(in, second);
  const json line = json::parse(first);
  EXPECT_EQ(line["frame"], 7);
  EXPECT_EQ(line["t"], 12.5);
  ASSERT_EQ(line["objects"].size(), 1u);
  const json& box = line["objects"][0];
  EXPECT_EQ(box["id"], scene.objects()[1].id);
  EXPECT_EQ(box["class"], scene.objects()[1].class_name);
  EXPECT_EQ(box["bbox"], json({10, 20, 40, 60}));
  EXPECT_EQ(box["full_bbox"], json({-5, 20, 40, 80}));
  EXPECT_EQ(box["visible"], 0.25);
  EXPECT_EQ(box["unoccluded"], 0.5);
  EXPECT_EQ(box["in_frame"], 0.75);
  EXPECT_EQ(box["px"], 345);
  EXPECT_EQ(box["z_med"], 2.125);
  EXPECT_TRUE(json::parse(second)["objects"].empty());
}

TEST(TruthFiles, ObjectsHavePoseSizeAndFootprint) {
  const test::TemporaryFolder folder;
  World world = test::exampleWorld();
  world.furniture[0].yaw_rad = 0.5;
  writeObjects(folder.file("objects.json"), Scene(world), 0);
  const json objects = json::parse(folder.read("objects.json"))["objects"];
  ASSERT_EQ(objects.size(), 3u);
  const json &block = objects[0], &door = objects[1], &person = objects[2];
  EXPECT_EQ(block["size_wdh"], json({0.6, 0.4, 1.0}));
  EXPECT_EQ(block["yaw"], 0.5);
  EXPECT_EQ(block["center"], json({3.5, 0.5, 0.5}));
  EXPECT_EQ(block["model"], "procedural:block");
  EXPECT_FALSE(block["moving"]);
  EXPECT_FALSE(block.contains("note"));
  // The shoelace formula gives the area of the turned block.
  double area = 0;
  const auto& corners = block["footprint"];
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
    area += (a[0].get<double>() * b[1].get<double>() - a[1].get<double>() * b[0].get<double>()) / 2;
  }
  EXPECT_NEAR(area, 0.6 * 0.4, 1e-3);
  EXPECT_EQ(door["class"], "door");
  EXPECT_EQ(door["footprint"].size(), 4u);
  EXPECT_TRUE(person["moving"]);
  EXPECT_TRUE(person.contains("note"));
}

TEST(TruthFiles, TheCalibrationIsThatOfTheWorld) {
  const test::TemporaryFolder folder;
  World world = test::exampleWorld();
  world.camera->pitch_down_rad = 0.3;
  world.lidar->at_m = {0.1, -0.2, 0.3};
  const Scene scene(world);
  writeCalibration(folder.file("c.json"), world, scene);
  const json out = json::parse(folder.read("c.json"));
  EXPECT_EQ(out["camera"]["fx"], 525);
  EXPECT_EQ(out["camera"]["depth_range_m"], json({0.45, 5.0}));
  EXPECT_EQ(out["robot_from_camera"]["t"], json({0.05, 0, 0.8}));
  // The optical axis, third column, points 0.3 rad below the horizon; the rows of the picture down and back.
  const auto at = [&](int r, int c) {
    return out["robot_from_camera"]["R"][static_cast<std::size_t>(r)][static_cast<std::size_t>(c)].get<double>();
  };
  EXPECT_NEAR(at(0, 2), std::cos(0.3), 1e-9);
  EXPECT_NEAR(at(2, 2), -std::sin(0.3), 1e-9);
  EXPECT_NEAR(at(1, 0), -1, 1e-9);
  EXPECT_NEAR(at(2, 1), -std::cos(0.3), 1e-9);
  EXPECT_EQ(out["robot_from_lidar"]["t"], json({0.1, -0.2, 0.3}));
  EXPECT_NEAR(out["lidar"]["angle_increment_rad"].get<double>(), 2 * 3.14159265358979 / 359, 1e-12);
  EXPECT_EQ(out["robot"]["radius"], 0.18);
  EXPECT_EQ(out["odometry_rate_hz"], 20);
  world.lidar.reset();
  world.odometry.reset();
  writeCalibration(folder.file("c.json"), world, scene);
  const json without = json::parse(folder.read("c.json"));
  EXPECT_FALSE(without.contains("lidar") || without.contains("robot_from_lidar"));
  EXPECT_FALSE(without.contains("odometry_rate_hz"));
}

TEST(TruthFiles, TheMapIsFreeWhereTheRobotCanGet) {
  const test::TemporaryFolder folder;
  const auto rectangle = [](double x0, double y0, double x1, double y1) {
    const Eigen::Vector2d a(x0, y0), b(x1, y0), c(x1, y1), d(x0, y1);
    return std::vector<Segment>{{a, b}, {b, c}, {c, d}, {d, a}};
  };
  auto outlines = rectangle(-1.02, -2.02, 4.98, 1.98);           // the room
  for (const auto& s : rectangle(2.03, 0.53, 3.03, 1.53)) outlines.push_back(s);  // a box in it
  writeMapTruth(folder.file("m.pgm"), folder.file("m.yaml"), outlines);
  std::istringstream in(folder.read("m.pgm"));
  std::string magic;
  int columns = 0, rows = 0, most = 0;
  in >> magic >> columns >> rows >> most;
  in.get();
  ASSERT_EQ(magic, "P5");
  ASSERT_EQ(most, 255);
  const std::string pixels(std::istreambuf_iterator<char>(in), {});
  ASSERT_EQ(pixels.size(), static_cast<std::size_t>(columns * rows));
  EXPECT_NE(folder.read("m.yaml").find("resolution: 0.050\norigin: [-2.000, -3.000, 0.0]"), std::string::npos);
  const auto cell = [&](double x, double y) {  // the picture's first row is the highest y
    const int column = static_cast<int>((x + 2) / 0.05), row = rows - 1 - static_cast<int>((y + 3) / 0.05);
    return static_cast<unsigned char>(pixels[static_cast<std::size_t>(row * columns + column)]);
  };
  Random random(5);
  for (int i = 0; i < 4000; ++i) {
    const double x = random.uniform(-1.9, 5.4), y = random.uniform(-2.9, 2.4);
    const auto inside = [&](double x0, double y0, double x1, double y1, double grow) {
      return x > x0 - grow && x < x1 + grow && y > y0 - grow && y < y1 + grow;
    };
    // 6 cm on either side of an outline are not judged.
    if (inside(2.03, 0.53, 3.03, 1.53, -0.06) || !inside(-1.02, -2.02, 4.98, 1.98, 0.06)) {
      EXPECT_EQ(cell(x, y), 205) << x << " " << y;
    }
    if (inside(-1.02, -2.02, 4.98, 1.98, -0.06) && !inside(2.03, 0.53, 3.03, 1.53, 0.06)) {
      EXPECT_EQ(cell(x, y), 254) << x << " " << y;
    }
  }
  for (double along = -1.0; along < 4.9; along += 0.05) EXPECT_EQ(cell(along, -2.02), 0) << along;
  for (double along = 0.55; along < 1.5; along += 0.05) EXPECT_EQ(cell(2.03, along), 0) << along;
}

}  // namespace
}  // namespace roomgraph
