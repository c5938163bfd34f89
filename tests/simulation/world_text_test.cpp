// SPDX-License-Identifier: BSD-3-Clause
// Written world files read back, for shipped worlds and for every optional key.
#include <gtest/gtest.h>

#include "example_world.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

constexpr double kClose = 2e-6, kEightBits = 0.5 / 255 + 1e-9;

void expectSame(const Room& a, const Room& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_LT((a.min_m - b.min_m).norm() + (a.max_m - b.max_m).norm(), kClose);
  EXPECT_EQ(a.wall.pattern, b.wall.pattern);
  EXPECT_EQ(a.floor.pattern, b.floor.pattern);
  EXPECT_NEAR(a.wall.size_m, b.wall.size_m, kClose);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(a.floor.rgb[k], b.floor.rgb[k], kEightBits);
  ASSERT_EQ(a.doorways.size(), b.doorways.size());
  for (std::size_t i = 0; i < a.doorways.size(); ++i) {
    EXPECT_EQ(a.doorways[i].side, b.doorways[i].side);
    EXPECT_EQ(a.doorways[i].door, b.doorways[i].door);
    EXPECT_NEAR(a.doorways[i].at_m, b.doorways[i].at_m, kClose);
    EXPECT_NEAR(a.doorways[i].width_m, b.doorways[i].width_m, kClose);
    EXPECT_NEAR(a.doorways[i].height_m, b.doorways[i].height_m, kClose);
  }
  ASSERT_EQ(a.posters.size(), b.posters.size());
  for (std::size_t i = 0; i < a.posters.size(); ++i) {
    EXPECT_EQ(a.posters[i].side, b.posters[i].side);
    EXPECT_EQ(a.posters[i].variant, b.posters[i].variant);
    EXPECT_NEAR(a.posters[i].z_m, b.posters[i].z_m, kClose);
    EXPECT_NEAR(a.posters[i].at_m, b.posters[i].at_m, kClose);
  }
}

void expectSame(const Furniture& a, const Furniture& b) {
  EXPECT_EQ(a.model, b.model);
  EXPECT_EQ(a.shape, b.shape);
  EXPECT_EQ(a.mesh_file, b.mesh_file);
  EXPECT_LT((a.at_m - b.at_m).norm(), kClose);
  EXPECT_NEAR(a.yaw_rad, b.yaw_rad, kClose);
  ASSERT_EQ(a.size_m.has_value(), b.size_m.has_value());
  if (a.size_m) {
    EXPECT_LT((*a.size_m - *b.size_m).norm(), kClose);
  }
  EXPECT_EQ(a.color.has_value(), b.color.has_value());
  ASSERT_EQ(a.moves.size(), b.moves.size());
  for (std::size_t i = 0; i < a.moves.size(); ++i) {
    EXPECT_NEAR(a.moves[i].at_s, b.moves[i].at_s, kClose);
    EXPECT_LT((a.moves[i].at_m - b.moves[i].at_m).norm(), kClose);
    EXPECT_NEAR(a.moves[i].yaw_rad, b.moves[i].yaw_rad, kClose);
  }
}

void expectSame(const Person& a, const Person& b) {
  ASSERT_EQ(a.path_m.size(), b.path_m.size());
  for (std::size_t i = 0; i < a.path_m.size(); ++i) EXPECT_LT((a.path_m[i] - b.path_m[i]).norm(), kClose);
  EXPECT_EQ(a.sits, b.sits);
  EXPECT_NEAR(a.speed_m_s, b.speed_m_s, kClose);
  EXPECT_NEAR(a.start_s, b.start_s, kClose);
  EXPECT_NEAR(a.yaw_rad, b.yaw_rad, kClose);
  EXPECT_NEAR(a.seat_height_m, b.seat_height_m, kClose);
  EXPECT_NEAR(a.height_m, b.height_m, kClose);
  EXPECT_NEAR(a.hair[1], b.hair[1], kEightBits);
}

void expectSameSensors(const World& a, const World& b) {
  ASSERT_EQ(a.camera.has_value(), b.camera.has_value());
  if (a.camera) {
    EXPECT_EQ(a.camera->model.width, b.camera->model.width);
    EXPECT_NEAR(a.camera->model.fx, b.camera->model.fx, kClose);
    EXPECT_NEAR(a.camera->pitch_down_rad, b.camera->pitch_down_rad, kClose);
    EXPECT_LT((a.camera->at_m - b.camera->at_m).norm(), kClose);
    EXPECT_NEAR(a.camera->noise_gain, b.camera->noise_gain, kClose);
    EXPECT_NEAR(a.camera->far_m, b.camera->far_m, kClose);
    EXPECT_EQ(a.camera->jpeg_quality, b.camera->jpeg_quality);
  }
  ASSERT_EQ(a.lidar.has_value(), b.lidar.has_value());
  if (a.lidar) {
    EXPECT_EQ(a.lidar->beams, b.lidar->beams);
    EXPECT_NEAR(a.lidar->sigma_relative, b.lidar->sigma_relative, kClose);
    EXPECT_NEAR(a.lidar->max_m, b.lidar->max_m, kClose);
    EXPECT_LT((a.lidar->at_m - b.lidar->at_m).norm(), kClose);
  }
  ASSERT_EQ(a.odometry.has_value(), b.odometry.has_value());
  if (a.odometry) {
    EXPECT_EQ(a.odometry->slips, b.odometry->slips);
    EXPECT_NEAR(a.odometry->slip_rad, b.odometry->slip_rad, kClose);
    EXPECT_NEAR(a.odometry->drift_rad_m, b.odometry->drift_rad_m, kClose);
    EXPECT_NEAR(a.odometry->scale_error, b.odometry->scale_error, kClose);
  }
  ASSERT_EQ(a.detections.has_value(), b.detections.has_value());
  if (a.detections) {
    EXPECT_EQ(a.detections->persistent, b.detections->persistent);
    EXPECT_NEAR(a.detections->mislead, b.detections->mislead, kClose);
    EXPECT_NEAR(a.detections->memory_s, b.detections->memory_s, kClose);
    EXPECT_NEAR(a.detections->confusion, b.detections->confusion, kClose);
    EXPECT_NEAR(a.detections->jitter, b.detections->jitter, kClose);
  }
}

void expectSame(const World& a, const World& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.duration_s, b.duration_s);
  EXPECT_NEAR(a.wall_height_m, b.wall_height_m, kClose);
  EXPECT_NEAR(a.wall_thickness_m, b.wall_thickness_m, kClose);
  EXPECT_NEAR(a.light, b.light, kClose);
  ASSERT_EQ(a.rooms.size(), b.rooms.size());
  for (std::size_t i = 0; i < a.rooms.size(); ++i) expectSame(a.rooms[i], b.rooms[i]);
  ASSERT_EQ(a.furniture.size(), b.furniture.size());
  for (std::size_t i = 0; i < a.furniture.size(); ++i) expectSame(a.furniture[i], b.furniture[i]);
  ASSERT_EQ(a.people.size(), b.people.size());
  for (std::size_t i = 0; i < a.people.size(); ++i) expectSame(a.people[i], b.people[i]);
  ASSERT_EQ(a.robot.has_value(), b.robot.has_value());
  if (a.robot) {
    EXPECT_EQ(a.robot->closed, b.robot->closed);
    ASSERT_EQ(a.robot->path_m.size(), b.robot->path_m.size());
    EXPECT_LT((a.robot->path_m.back() - b.robot->path_m.back()).norm(), kClose);
    EXPECT_NEAR(a.robot->max_turn_rad_s, b.robot->max_turn_rad_s, kClose);
    EXPECT_NEAR(a.robot->radius_m, b.robot->radius_m, kClose);
  }
  ASSERT_EQ(a.handheld.has_value(), b.handheld.has_value());
  if (a.handheld) {
    ASSERT_EQ(a.handheld->keys.size(), b.handheld->keys.size());
    EXPECT_LT((a.handheld->keys[1].look_at_m - b.handheld->keys[1].look_at_m).norm(), kClose);
    EXPECT_NEAR(a.handheld->speed_m_s, b.handheld->speed_m_s, kClose);
  }
  expectSameSensors(a, b);
}

TEST(WorldText, ShippedWorldsAreReadBackAsTheyWere) {
  for (const std::string name : {"lab", "corridor", "office_handheld", "empty_room", "crowd", "flat"}) {
    SCOPED_TRACE(name);
    const World world = readWorld(std::filesystem::path(ROOMGRAPH_SOURCE_DIR) / "worlds" / (name + ".json"));
    expectSame(world, parseWorld(worldText(world), "again.json"));
  }
}

TEST(WorldText, OptionalKeysAreReadBackToo) {
  std::string text = test::changed("\"name\": \"example\"", "\"name\": \"example\", \"light\": 0.6, \"duration_s\": 2.5");
  const std::string item = "\"color\": \"#000000\"", camera = "\"camera\": {";
  text.replace(text.find(item), item.size(), item + ", \"shape\": 7, \"yaw_deg\": 33, \"moves\": [{\"at_s\": 3.5, \"at_m\": [4, 2], \"yaw_deg\": 20}, "
                                               "{\"at_s\": 7, \"at_m\": [4.2, 2.1], \"z_m\": 0.2}]");
  text.replace(text.find(camera), camera.size(), "\"detections\": {\"errors\": \"persistent\", \"mislead\": 0.7, \"memory_s\": 2, "
                                                 "\"duplicates\": 0.1}, " + camera);
  const World world = parseWorld(text, "w.json");
  EXPECT_EQ(world.light, 0.6);
  EXPECT_EQ(world.furniture[0].shape, 7);
  EXPECT_EQ(world.furniture[0].moves.size(), 2u);
  ASSERT_TRUE(world.detections);
  EXPECT_TRUE(world.detections->persistent);
  EXPECT_EQ(world.detections->mislead, 0.7);
  EXPECT_EQ(world.detections->duplicates, 0.1);
  const std::string written = worldText(world, "why it is there");
  EXPECT_NE(written.find("why it is there"), std::string::npos);
  expectSame(world, parseWorld(written, "again.json"));
  EXPECT_EQ(worldText(parseWorld(written, "a"), "why it is there"), written);
}

}  // namespace
}  // namespace roomgraph
