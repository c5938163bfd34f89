// SPDX-License-Identifier: BSD-3-Clause
// The shipped worlds can be built and contain what they are meant to.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/simulation/world_file.h"
#include "scene.h"

namespace roomgraph {
namespace {

const std::filesystem::path kWorlds = std::filesystem::path(ROOMGRAPH_SOURCE_DIR) / "worlds";

TEST(ShippedWorlds, AllCanBeSimulated) {
  for (const std::string name : {"lab", "corridor", "office_handheld", "empty_room", "crowd", "small_loop", "board"}) {
    const World world = readWorld(kWorlds / (name + ".json"));
    EXPECT_EQ(world.name, name);
    EXPECT_GT(Scene(world).duration(), 20) << name;
  }
}

TEST(ShippedWorlds, TheLabHoldsWhatThePipelineIsMeasuredOn) {
  const Scene scene(readWorld(kWorlds / "lab.json"));
  const auto count = [&](const std::string& name) {
    return std::count_if(scene.objects().begin(), scene.objects().end(),
                         [&](const SceneObject& object) { return object.class_name == name; });
  };
  EXPECT_GE(count("swivel_chair"), 6);
  EXPECT_GE(count("sofa"), 2);
  EXPECT_GE(count("door"), 2);
  EXPECT_EQ(
      std::count_if(scene.objects().begin(), scene.objects().end(), [](const auto& o) { return o.moving; }),
      2);
  // Two chairs side by side: nearer than a metre.
  double nearest = 9;
  for (const auto& a : scene.objects())
    for (const auto& b : scene.objects())
      if (a.id < b.id && a.class_name == "swivel_chair" && b.class_name == "swivel_chair")
        nearest =
            std::min(nearest, (a.world_from_object.translation() - b.world_from_object.translation()).norm());
  EXPECT_LT(nearest, 1);
  // The robot comes back to where it was.
  const double end = scene.duration();
  double again = 9;
  for (double t = end * 0.8; t < end; t += 0.1)
    again = std::min(again, scene.worldFromRobot(t).translation().norm());
  EXPECT_LT(again, 0.3);
}

TEST(ShippedWorlds, TheHandHeldOneHasACameraOnly) {
  const World world = readWorld(kWorlds / "office_handheld.json");
  EXPECT_TRUE(world.handheld && world.camera);
  EXPECT_FALSE(world.robot || world.lidar || world.odometry);
}

}  // namespace
}  // namespace roomgraph
