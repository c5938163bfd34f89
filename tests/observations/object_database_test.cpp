// SPDX-License-Identifier: BSD-3-Clause
// Object database: shipped file, lookup by label, strict parsing.
#include "roomgraph/observations/object_database.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using test::messageOf;

TEST(ObjectDatabase, ShippedFileLoads) {
  const auto database = ObjectDatabase::fromFile(std::string(ROOMGRAPH_SOURCE_DIR) + "/objects.ini");
  for (const char* name : {"swivel_chair", "sofa", "door", "person"})
    ASSERT_TRUE(database.find(name)) << name;
  EXPECT_EQ(database.find("swivel_chair")->nominal().kind, ShapeKind::kCylinder);
  EXPECT_EQ(database.find("swivel_chair")->color, "#e6862a") << "# is no comment inside a value";
  EXPECT_EQ(database.find("door")->symmetry, 2);
  EXPECT_FALSE(database.find("person")->landmark);
  EXPECT_TRUE(database.find("sofa")->landmark);
  EXPECT_TRUE(database.moves("person"));
  for (const char* name : {"swivel_chair", "sofa", "door", "unicorn"}) EXPECT_FALSE(database.moves(name)) << name;
  EXPECT_EQ(database.find("sofa")->frontRule(), FrontRule::kHighBack);
  EXPECT_EQ(database.find("door")->frontRule(), FrontRule::kNone) << "both sides are alike";
  EXPECT_EQ(database.find("swivel_chair")->frontRule(), FrontRule::kNone) << "a cylinder has no yaw";
  EXPECT_EQ(database.find("sofa")->generatorName(), "CuboidGenerator");
  EXPECT_EQ(database.find("door")->generatorName(), "DoorGenerator");
  EXPECT_EQ(database.find("person")->generatorName(), "CylinderGenerator");
  EXPECT_EQ(database.find("sofa")->solid_share, 0.4);
  EXPECT_EQ(database.find("swivel_chair")->solid_share, 0);
}

TEST(ObjectDatabase, WhatIsNeverMappedMovesUnlessTheFileSaysOtherwise) {
  const auto database = ObjectDatabase::fromText(
      "[person]\nlandmark = false\n[curtain]\nlandmark = false\nmoves = false\n[sofa]\nlabels = sofa\n");
  EXPECT_TRUE(database.moves("person"));
  EXPECT_FALSE(database.moves("curtain"));
  EXPECT_FALSE(database.moves("sofa"));
}

TEST(ObjectDatabase, LooksUpByLabelWhateverTheCase) {
  const auto database = ObjectDatabase::fromText("[seat]\nlabels = Chair, arm chair\n[lamp]\n");
  EXPECT_EQ(database.byLabel("chair"), database.find("seat"));
  EXPECT_EQ(database.byLabel("ARM CHAIR"), database.find("seat"));
  EXPECT_EQ(database.byLabel("lamp"), nullptr) << "a class without labels is never detected";
  EXPECT_EQ(database.byLabel(""), nullptr);
  EXPECT_EQ(database.find("Seat"), nullptr);
  EXPECT_EQ(database.models().size(), 1u) << "a section without any key is none";
}

// A size that is said to be exact is one within 1 cm: dividing by its deviation gives a number.
TEST(ObjectDatabase, SizesAreComparedInStandardDeviations) {
  const auto database = ObjectDatabase::fromText(
      "[tv]\nlabels = tv\nwidth_m = 1\ndepth_m = 0.1\nheight_m = 0.6\n"
      "width_sigma_m = 0.2\ndepth_sigma_m = 0\nheight_sigma_m = 0.05\n");
  const ObjectModel& tv = *database.find("tv");
  EXPECT_TRUE(tv.sizeSigma().isApprox(Eigen::Vector3d(0.2, 0.01, 0.05)));
  EXPECT_EQ(tv.sizeDistance2(tv.nominal()), 0);
  ObjectShape other = tv.nominal();
  other.width += 0.4, other.depth -= 0.03, other.height += 0.05;
  EXPECT_NEAR(tv.sizeDistance2(other), 4 + 9 + 1, 1e-9);
}

TEST(ObjectDatabase, NewClassNeedsNoCode) {
  const auto database =
      ObjectDatabase::fromText("[desk]\nlabels = table\nwidth_m = 1.6\ndepth_m = 0.8\nheight_m = 0.75\n");
  const auto shape = database.find("desk")->nominal();
  EXPECT_EQ(shape.kind, ShapeKind::kCuboid);
  EXPECT_EQ(shape.width, 1.6);
  EXPECT_EQ(shape.depth, 0.8);
  EXPECT_EQ(shape.height, 0.75);
}

std::string complaint(const std::string& text) {
  return messageOf<ConfigError>([&] { ObjectDatabase::fromText(text, "o.ini"); });
}

TEST(ObjectDatabase, IsStrict) {
  EXPECT_THAT(complaint("[a]\nwidth = 1\n"),
              AllOf(HasSubstr("o.ini:2"), HasSubstr("did you mean 'width_m'?")));
  EXPECT_THAT(complaint("[a]\nshape = sphere\n"), HasSubstr("one of cylinder, cuboid, planar"));
  EXPECT_THAT(complaint("[a]\nwidth_m = 0\n"), HasSubstr("a number in [0.01, 20]"));
  EXPECT_THAT(complaint("[a]\nsymmetry = 7\n"), HasSubstr("[0, 4]"));
  EXPECT_THAT(complaint("[a]\ncolor = #fff000\ncolor = #000000\n"), HasSubstr("is set twice"));
  EXPECT_THAT(complaint("[b]\nlandmark = true\n[a]\nlandmark = perhaps\n"),
              HasSubstr("o.ini:4: [a] landmark"));
  EXPECT_THAT(complaint("[a]\nlabels = x\nfront = left\n"),
              AllOf(HasSubstr("o.ini:3: [a] front"), HasSubstr("one of high_back, near_side, none")));
  EXPECT_THAT(complaint("[a]\nshape = planar\nfront = high_back\n"),
              HasSubstr("o.ini:3: [a] front = high_back: only a cuboid has a back"));
  EXPECT_THAT(complaint("[a]\nsolid_share = 2\n"), HasSubstr("o.ini:2: [a] solid_share"));
  EXPECT_THAT(complaint("[sofa]\nlabels = couch, Chair\n[chair]\nlabels = stool, chair\n"),
              HasSubstr("o.ini:4: [chair] labels: 'chair' means [sofa] already"));
  EXPECT_THAT(complaint("[dog]\nmoves = true\n"), HasSubstr("o.ini:2: [dog] moves: what moves by itself is no landmark"));
  EXPECT_THROW(ObjectDatabase::fromFile("no_such_objects.ini"), InputError);
}

TEST(ObjectDatabase, MarkdownNamesTheKeys) {
  const auto page = ObjectDatabase::markdown();
  for (const char* key : {"labels", "shape", "width_m", "symmetry", "landmark", "color"})
    EXPECT_THAT(page, HasSubstr("| `" + std::string(key) + "` |"));
}

}  // namespace
}  // namespace roomgraph
