// SPDX-License-Identifier: BSD-3-Clause
// Loading of plug-ins outside libs/ as shared libraries, use of their classes, and refusal of wrong ones.
#include <dlfcn.h>
#include <gmock/gmock.h>

#include <cstdio>

#include "errors_of.h"
#include "network_decoders.h"
#include "roomgraph/association/associator.h"
#include "roomgraph/association/register_classes.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/config.h"
#include "roomgraph/core/plugin.h"
#include "roomgraph/detection/register_classes.h"

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

  loadPlugin(EXAMPLE_ASSOCIATOR);
  loadPlugin(EXAMPLE_ASSOCIATOR);  // twice is once
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

// The output of a network with two classes and three boxes, written by hand.
TEST(Plugin, ANetworkDecoderTakesPart) {
  detection::registerClasses();
  EXPECT_FALSE(decoderNamed("yolov8"));
  loadPlugin(EXAMPLE_DECODER);
  ASSERT_TRUE(decoderNamed("yolov8"));
  EXPECT_EQ(knownFormats(), "auto, ade20k, darknet, nanodet, room, yolov8, yolox");

  const int size[] = {1, 4 + 2, 3};
  cv::Mat blob(3, size, CV_32FC1, cv::Scalar(0));
  const float columns[3][6] = {{50, 40, 20, 10, 0.2f, 0.9f}, {10, 10, 4, 4, 0.1f, 0.1f}, {10, 10, 0, 4, 0.8f, 0}};
  for (int box = 0; box < 3; ++box)
    for (int row = 0; row < 6; ++row) blob.at<float>(0, row, box) = columns[box][row];
  const NetworkOutputs outputs{"x.onnx", {64, 64}, {blob}};
  const auto decoder = decoderFor(outputs, 2);
  ASSERT_TRUE(decoder);
  EXPECT_EQ(decoder->name(), "yolov8");
  const auto boxes = decoder->decode(outputs, {2, {0, 1}, 0.5});
  ASSERT_EQ(boxes.size(), 1u) << "the second is below the score, the third has no width";
  EXPECT_EQ(boxes[0].box, (Box2{40, 35, 60, 45}));
  EXPECT_EQ(boxes[0].class_index, 1);
  EXPECT_FALSE(decoderFor(outputs, 3)) << "as many classes as there are labels";
}

TEST(Plugin, AnotherVersionOfTheInterfacesIsRefused) {
  EXPECT_THAT(messageOf<ConfigError>([] { loadPlugin(ODD_VERSION); }),
              ::testing::AllOf(HasSubstr("odd_version.so: was compiled with version 777 of the interfaces"),
                               HasSubstr("this program has version " + std::to_string(kPluginInterfaceVersion)),
                               HasSubstr("compile it again")));
}

TEST(Plugin, ALibraryThatIsNoneIsRefused) {
  Dl_info c_library{};
  ASSERT_NE(dladdr(reinterpret_cast<void*>(&std::fopen), &c_library), 0);
  EXPECT_THAT(messageOf<ConfigError>([&] { loadPlugin(c_library.dli_fname); }),
              HasSubstr("it is no plug-in, or ROOMGRAPH_PLUGIN() is missing"));
  EXPECT_THAT(messageOf<ConfigError>([&] { loadPlugin(ODD_EMPTY); }), HasSubstr("registers no class"));
}

TEST(Plugin, WhatIsNoSharedLibraryIsAConfigError) {
  EXPECT_THAT(messageOf<ConfigError>([] { loadPlugin(ROOMGRAPH_SOURCE_DIR "/objects.ini"); }),
              HasSubstr("objects.ini"));
}

// Not looked for where the system's libraries are: the C library would be found there.
TEST(Plugin, ABareNameMeansTheWorkingDirectory) {
  EXPECT_THAT(messageOf<ConfigError>([] { loadPlugin("libc.so.6"); }),
              ::testing::AllOf(HasSubstr("libc.so.6: "), HasSubstr("cannot open shared object file")));
}

// Two plug-ins that were copied from one example.
TEST(Plugin, AClassNameThatIsTakenIsRefused) {
  association::registerClasses();
  loadPlugin(EXAMPLE_ASSOCIATOR);
  EXPECT_THAT(messageOf<ConfigError>([] { loadPlugin(ODD_TWIN); }),
              ::testing::AllOf(HasSubstr("odd_twin.so"), HasSubstr("example::GreedyNearestAssociator"),
                               HasSubstr("registered already")));
}

}  // namespace
}  // namespace roomgraph
