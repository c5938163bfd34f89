// SPDX-License-Identifier: BSD-3-Clause
// Shape generators chosen by name in the object database, one of them from a plug-in.
#include <gmock/gmock.h>

#include <numbers>

#include "errors_of.h"
#include "geometric_proposal_generator.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/config.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/proposals/register_classes.h"
#include "scene.h"

namespace roomgraph {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::Field;
using ::testing::HasSubstr;
using test::messageOf;

ObjectDatabase withGenerator(const std::string& name) {
  return ObjectDatabase::fromText("[cabinet]\nlabels = cabinet\nwidth_m = 0.9\ndepth_m = 0.45\nheight_m = 1.1\ngenerator = " +
                                      name + "\n[chair]\nlabels = chair\nshape = cylinder\nwidth_m = 0.6\ndepth_m = 0.6\n",
                                  "my_objects.ini");
}

TEST(ShapeGenerators, AnUnknownNameIsAnErrorThatListsTheKnownOnes) {
  const auto complaint = messageOf<ConfigError>([] { ShapeGenerators(withGenerator("CubiodGenerator")); });
  EXPECT_THAT(complaint, AllOf(HasSubstr("my_objects.ini:6: [cabinet] generator: no class 'CubiodGenerator'"),
                               HasSubstr("did you mean 'CuboidGenerator'?"),
                               HasSubstr("CuboidGenerator, CylinderGenerator, DoorGenerator")));
  // A stage of another kind is no shape generator.
  EXPECT_THROW(ShapeGenerators(withGenerator("GeometricProposalGenerator")), ConfigError);
}

TEST(ShapeGenerators, OnePerNameWithItsParameters) {
  const auto database = withGenerator("CylinderGenerator");
  std::vector<std::string> made;
  const ShapeGenerators generators(database, [&](const std::string& name, const std::string& asked_by) {
    made.push_back(name + " for " + asked_by);
    return createStage<ShapeGenerator>(name, asked_by);
  });
  EXPECT_THAT(made, ::testing::ElementsAre("CylinderGenerator for my_objects.ini:6: [cabinet] generator"));
  EXPECT_EQ(&generators.of(*database.find("cabinet")), &generators.of(*database.find("chair")));
  EXPECT_THROW(generators.of(*test::database().find("sofa")), std::out_of_range);
}

// A cabinet before the camera, through the whole stage: the plug-in's shapes come out, and are right.
TEST(ShapeGenerators, OneFromAPlugInMakesTheShapesOfItsClass) {
  proposals::registerClasses();
  loadPlugin(EXAMPLE_GENERATOR);
  const auto database = withGenerator("NearestPointsGenerator");
  test::Scene scene;
  scene.lookAhead(0.8, 0.2);
  scene.addBox(2.6, 0.1, std::numbers::pi, 0.9, 0.45, 0, 1.1, 1);
  scene.addCylinder(2.0, -0.9, 0.3, 0.95, 2);
  cv::Mat labels;
  const Frame frame = scene.render(&labels);
  const std::vector<Detection> detections{test::detectionOf(1, labels, "cabinet"), test::detectionOf(2, labels, "chair")};
  const Plane ground = groundInCamera(scene.world_from_camera);
  const auto sourcesOf = [&](const char* parameters) {
    GeometricProposalGenerator stage;
    stage.setDatabase(database);
    stage.setShapeGenerators(ShapeGenerators(database, [&](const std::string& name, const std::string& asked_by) {
      auto generator = createStage<ShapeGenerator>(name, asked_by);
      Config::fromText(parameters).read("shape_generators", *generator);
      return generator;
    }));
    stage.prepare();
    return stage.generate(frame, detections, {GroundEstimate{.plane = ground, .from_depth = true}, ""}).proposals;
  };
  const auto found = sourcesOf("[shape_generators]\nnear_share = 0.1\n");
  ASSERT_GE(found.size(), 2u);
  EXPECT_EQ(found.front().source, "nearest points");
  const Pose3 cabinet = scene.world_from_camera * found.front().camera_from_object;
  EXPECT_LT((cabinet.translation() - Eigen::Vector3d(2.6, 0.1, 0)).norm(), 0.08);
  EXPECT_EQ(found.back().detection, 1);
  EXPECT_EQ(found.back().source, "depth") << "the other class keeps the shipped one";
  EXPECT_THROW(sourcesOf("[shape_generators]\nnear_share = 2\n"), ConfigError) << "its parameters are read";
}

}  // namespace
}  // namespace roomgraph
