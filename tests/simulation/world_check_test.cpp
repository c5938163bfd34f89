// SPDX-License-Identifier: BSD-3-Clause
// What a world may not be: posters off their wall, paths through people's doors, cameras in walls.
#include "world_check.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "example_world.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string worldError(const World& world) {
  return test::messageOf<ConfigError>([&] { checkWorld(world); });
}

TEST(WorldCheck, PostersFitOnTheirWall) {
  World world = test::exampleWorld();
  world.rooms[0].posters = {{Side::kWest, 0.4, 1.5, 0.8, 1.0, 0}};
  EXPECT_NO_THROW(checkWorld(world));
  for (const Poster& poster : {Poster{Side::kWest, 0.39, 1.5, 0.8, 1.0, 0}, Poster{Side::kWest, 3.61, 1.5, 0.8, 1.0, 0},
                               Poster{Side::kNorth, 0.39, 1.5, 0.8, 1.0, 0}, Poster{Side::kWest, 2, 0.4, 0.8, 1.0, 0},
                               Poster{Side::kWest, 2, 2.2, 0.8, 1.0, 0}}) {
    world.rooms[0].posters = {Poster{Side::kSouth, 3, 1.5, 0.8, 1.0, 0}, poster};
    EXPECT_THAT(worldError(world), HasSubstr("example.json: rooms[0].posters[1]: does not fit")) << poster.at_m;
  }
}

TEST(WorldCheck, AnOpenDoorwayLeadsIntoARoomBehindTheWall) {
  World world = test::exampleWorld();
  world.rooms[0].doorways[0].door = DoorState::kNone;
  Room behind = world.rooms[0];
  behind.doorways.clear();
  behind.place = "rooms[1]";
  const double wall = world.wall_thickness_m;
  behind.min_m = {4, 4 + wall};
  behind.max_m = {6, 6 + wall};
  world.rooms.push_back(behind);
  EXPECT_NO_THROW(checkWorld(world));
  for (const Eigen::Vector2d& off : {Eigen::Vector2d(0, 0.1), Eigen::Vector2d(1.2, 0)}) {  // too far; half beside it
    world.rooms[1].min_m = behind.min_m + off;
    world.rooms[1].max_m = behind.max_m + off;
    EXPECT_THAT(worldError(world), HasSubstr("rooms[0].doorways[0]: leads into nothing")) << off.transpose();
  }
}

TEST(WorldCheck, PathsKeepOutOfClosedDoorsAndOtherThings) {
  World world = test::exampleWorld();
  world.rooms[0].doorways[0].door = DoorState::kClosed;
  world.people[0].path_m = {{5, 3.4}, {5, 4.06}};
  EXPECT_THAT(worldError(world), HasSubstr("people[0].path_m"));
  world.people[0].path_m = {{3.5, 2.5}, {5.5, 2.5}};
  EXPECT_THAT(worldError(world), AllOf(HasSubstr("people[0].path_m"), HasSubstr("furniture[0] (block)")));
  // Somebody who sits may be where furniture is.
  world.people[0].path_m = {{4.5, 2.5}};
  EXPECT_NO_THROW(checkWorld(world));
  // What hangs high is no obstacle.
  world.people[0].path_m = {{3.5, 2.5}, {5.5, 2.5}};
  world.furniture[0].at_m.z() = 1.5;
  EXPECT_NO_THROW(checkWorld(world));
}

TEST(WorldCheck, AHandHeldCameraStaysInTheRoom) {
  World world = test::exampleWorld();
  world.robot.reset();
  const auto moving = [&](const Eigen::Vector3d& to) {
    world.handheld = HandheldSpec{{{{1, 2, 1.2}, {5, 2, 1}}, {to, {5, 2, 1}}}, false, 0.3, "handheld"};
    checkWorld(world);
  };
  EXPECT_NO_THROW(moving({3, 2, 1.4}));
  for (const Eigen::Vector3d& to : {Eigen::Vector3d(3, 4.5, 1.4), {3, 2, 2.59}, {3, 2, 0.02}})
    EXPECT_THAT(test::messageOf<ConfigError>([&] { moving(to); }), HasSubstr("handheld.views")) << to.transpose();
}

TEST(WorldCheck, FurnitureIsJudgedTurned) {
  World world = test::exampleWorld();
  // 0.6 wide along y, 0.4 deep along x: at x = 5.75 it fits, and not when it is turned by 90 degrees.
  world.furniture[0].at_m = {5.75, 1.0, 0};
  EXPECT_NO_THROW(checkWorld(world));
  world.furniture[0].yaw_rad = 1.5707963;
  EXPECT_THAT(worldError(world), AllOf(HasSubstr("furniture[0]"), HasSubstr("stands in a wall")));
}

}  // namespace
}  // namespace roomgraph
