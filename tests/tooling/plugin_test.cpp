// SPDX-License-Identifier: BSD-3-Clause
// Loading of a plug-in outside libs/ as a shared library, and creation of its stage by name.
#include <dlfcn.h>
#include <gmock/gmock.h>

#include <cstdio>

#include "errors_of.h"
#include "roomgraph/association/associator.h"
#include "roomgraph/association/register_classes.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/config.h"

namespace roomgraph {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using test::messageOf;
using ::testing::Not;

constexpr const char* kName = "GreedyNearestAssociator";

WorldMeasurement measurement(const std::string& class_name, double x, double y) {
  WorldMeasurement out;
  out.measurement.proposal.class_name = class_name;
  out.world_from_object.translation() = Eigen::Vector3d(x, y, 0);
  return out;
}

Landmark landmark(int id, const std::string& class_name, double x, double y) {
  Landmark out;
  out.id = LandmarkId{id};
  out.class_name = class_name;
  out.position = {x, y, 0};
  return out;
}

TEST(Plugin, IsLoadedAndItsStageRuns) {
  association::registerClasses();
  EXPECT_THAT(implementationsOf(CLASS_ID(Associator)), Not(Contains(kName)));
  EXPECT_THAT(messageOf<ConfigError>([] { createStage<Associator>(kName, "[association] class"); }),
              HasSubstr("known: MaximumLikelihoodAssociator"));

  loadPlugin(EXAMPLE_PLUGIN);
  loadPlugin(EXAMPLE_PLUGIN);  // twice is once
  EXPECT_THAT(implementationsOf(CLASS_ID(Associator)), Contains(kName).Times(1));
  const auto stage = createStage<Associator>(kName, "[association] class");
  ASSERT_TRUE(stage);
  EXPECT_THAT(currentValues(*stage), ::testing::ElementsAre(::testing::Pair("gate_m", "0.5")));

  // Both measurements are nearest to landmark 4; the nearer one gets it, the other the next one of its class.
  const std::vector<WorldMeasurement> seen = {measurement("sofa", 0.3, 0), measurement("sofa", 0.1, 0)};
  const std::vector<Landmark> map = {landmark(3, "door", 0.1, 0), landmark(4, "sofa", 0, 0),
                                     landmark(5, "sofa", 0.7, 0)};
  const auto found = stage->associate(seen, map);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].landmark, LandmarkId{5});
  EXPECT_EQ(found[1].landmark, LandmarkId{4});

  Config::fromText("[association]\ngate_m = 0.2\n").read("association", *stage);
  EXPECT_FALSE(stage->associate(seen, map)[0].landmark.valid()) << "a smaller gate leaves it new";
}

TEST(Plugin, ALibraryWithoutStagesIsNone) {
  Dl_info c_library{};
  ASSERT_NE(dladdr(reinterpret_cast<void*>(&std::fopen), &c_library), 0);
  EXPECT_THAT(messageOf<ConfigError>([&] { loadPlugin(c_library.dli_fname); }),
              HasSubstr(": is a shared library, but registers no stage"));
}

TEST(Plugin, WhatIsNoSharedLibraryIsAConfigError) {
  EXPECT_THAT(messageOf<ConfigError>([] { loadPlugin(ROOMGRAPH_SOURCE_DIR "/objects.ini"); }),
              HasSubstr("objects.ini"));
}

}  // namespace
}  // namespace roomgraph
