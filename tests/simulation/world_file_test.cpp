// SPDX-License-Identifier: BSD-3-Clause
// World files: values read, and errors by file and entry.
#include "roomgraph/simulation/world_file.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "example_world.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using ::testing::AllOf;
using test::changed;
using ::testing::HasSubstr;
using ::testing::Not;

std::string complaint(const std::string& from, const std::string& to) {
  return test::messageOf<ConfigError>([&] { parseWorld(changed(from, to), "w.json"); });
}

TEST(WorldFile, ReadsWhatIsWritten) {
  const World world = test::exampleWorld();
  EXPECT_EQ(world.name, "example");
  ASSERT_EQ(world.rooms.size(), 1u);
  EXPECT_EQ(world.rooms[0].max_m, Eigen::Vector2d(6, 4));
  EXPECT_EQ(world.rooms[0].doorways[0].door, DoorState::kClosed);
  EXPECT_EQ(world.furniture[0].size_m.value(), Eigen::Vector3d(0.6, 0.4, 1.0));
  ASSERT_TRUE(world.camera && world.lidar && world.odometry);
  EXPECT_EQ(world.camera->pitch_down_rad, 0);
  EXPECT_FALSE(world.detections);
}

TEST(WorldFile, EveryMistakeNamesFileAndEntry) {
  EXPECT_THAT(complaint("\"size_m\": [6, 4]", "\"size_m\": [6, 4], \"colour\": 1"),
              AllOf(HasSubstr("w.json: rooms[0].colour"), HasSubstr("unknown key")));
  EXPECT_THAT(complaint("\"at_m\": 5", "\"at_m\": 5, \"width\": 1"), HasSubstr("did you mean 'width_m'"));
  EXPECT_THAT(complaint("\"at_m\": 5", "\"at_m\": 5, \"width_m\": -1"),
              AllOf(HasSubstr("rooms[0].doorways[0].width_m"), HasSubstr("-1")));
  EXPECT_THAT(complaint("\"model\": \"block\"", "\"model\": \"throne\""),
              AllOf(HasSubstr("furniture[0].model"), HasSubstr("throne"), HasSubstr("swivel_chair")));
  EXPECT_THAT(complaint("\"model\": \"block\", ", ""),
              AllOf(HasSubstr("furniture[0].model"), HasSubstr("missing")));
  EXPECT_THAT(complaint("\"preset\": \"rplidar\"", "\"rate_hz\": 0"), HasSubstr("sensors.lidar.rate_hz"));
  EXPECT_THAT(complaint("\"preset\": \"kobuki\"", "\"rate_hz\": 1e9"), HasSubstr("sensors.odometry.rate_hz"));
  EXPECT_THAT(complaint("\"preset\": \"kinect\"", "\"preset\": \"eye\""), HasSubstr("sensors.camera.preset"));
  EXPECT_THAT(complaint("#ffffff", "white"), HasSubstr("rooms[0].wall.color"));
  EXPECT_THAT(complaint("[1, 2]", "[1]"), HasSubstr("robot.path_m[0]"));
  EXPECT_THAT(complaint("[1, 2]", "[1e12, 2]"),
              AllOf(HasSubstr("robot.path_m[0]"), HasSubstr("must be within 1000 m")));
  EXPECT_THAT(complaint("\"name\": \"example\"", "\"name\": \"a b\""), HasSubstr("name"));
  EXPECT_THAT(complaint("\"rooms\"", "rooms"),
              AllOf(HasSubstr("w.json: not valid JSON: line "), Not(HasSubstr("exception"))));
  EXPECT_THAT(complaint("[1, 2]", "[1e999, 2]"), HasSubstr("the number 1e999 is too large"));
  EXPECT_THAT(test::messageOf<ConfigError>([] { parseWorld("", "w.json"); }),
              HasSubstr("w.json: is empty"));
  EXPECT_THAT(test::messageOf<InputError>([] { readWorld("/nowhere/w.json"); }),
              HasSubstr("/nowhere/w.json"));
}

TEST(WorldFile, RoomsMustNotOverlapNorShareTooThinAWall) {
  const std::string first = "\"rooms\": [",
                    second = "\"rooms\": [{\"corner_m\": [6.05, 0], \"size_m\": [2, 2]}, ";
  EXPECT_THAT(complaint(first, second), AllOf(HasSubstr("rooms[1]"), HasSubstr("overlaps rooms[0]")));
  std::string apart = second;
  apart.replace(apart.find("6.05"), 4, "6.12");
  EXPECT_NO_THROW(parseWorld(changed(first, apart), "w.json"));
}

TEST(WorldFile, DoorwaysLeadSomewhere) {
  EXPECT_THAT(complaint(", \"door\": \"closed\"", ""),
              AllOf(HasSubstr("rooms[0].doorways[0]"), HasSubstr("nothing")));
  EXPECT_THAT(complaint("\"at_m\": 5", "\"at_m\": 5.8"), HasSubstr("does not fit into its wall"));
}

TEST(WorldFile, NothingStandsInAWall) {
  EXPECT_THAT(complaint("[4.5, 2.5]", "[5.9, 2.5]"),
              AllOf(HasSubstr("furniture[0]"), HasSubstr("stands in a wall")));
  EXPECT_THAT(complaint("[0.6, 0.4, 1.0]", "[0.6, 0.4, 3.0]"), HasSubstr("higher than the room"));
  EXPECT_THAT(complaint("[[1, 3.4]", "[[1, 3.95]"), HasSubstr("people[0].path_m"));
}

TEST(WorldFile, ThePathKeepsClearOfWallsAndFurniture) {
  EXPECT_THAT(complaint("[3, 2]]", "[3, 5]]"), AllOf(HasSubstr("robot.path_m"), HasSubstr("through a wall")));
  EXPECT_THAT(complaint("[3, 2]]", "[5.5, 2.5]]"),
              AllOf(HasSubstr("robot.path_m"), HasSubstr("furniture[0] (block)")));
  EXPECT_THAT(complaint("[1, 2], [2, 2], [3, 2]", "[5, 2], [5, 3], [5, 4.1]"), HasSubstr("robot.path_m"));
}

TEST(WorldFile, AHandHeldCameraHasNoWheels) {
  const std::string handheld =
      R"("handheld": {"views": [{"at_m": [1, 2, 1], "look_at_m": [4, 2, 1]}, {"at_m": [2, 2, 1], "look_at_m": [4, 2, 1]}]})";
  const std::string robot = R"("robot": {"path_m": [[1, 2], [2, 2], [3, 2]]})";
  EXPECT_THAT(complaint(robot, handheld), HasSubstr("sensors.camera.pitch_down_deg"));
  EXPECT_THAT(complaint(robot, robot + ", " + handheld), HasSubstr("either robot or handheld"));
}

}  // namespace
}  // namespace roomgraph
