// SPDX-License-Identifier: BSD-3-Clause
// JsonEntry: values, ranges, fallbacks, and messages that name file and place.
#include "json_entry.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

JsonEntry entryOf(const std::string& text, const std::string& place = "robot") {
  return {nlohmann::json::parse(text), "folder/w.json", place};
}

template <class Action>
std::string entryError(const std::string& text, Action&& action) {
  return test::messageOf<ConfigError>([&] {
    JsonEntry entry = entryOf(text);
    action(entry);
  });
}

TEST(JsonEntry, ReadsWhatIsThereAndFallsBackWhenItIsNot) {
  JsonEntry entry = entryOf(R"({"n": 2.5, "i": 4, "f": true, "s": "x", "c": "b", "l": [1, 2], "rgb": "#ff8000", "z": null})");
  EXPECT_EQ(entry.number("n", 7, 0, 10), 2.5);
  EXPECT_EQ(entry.number("none", 7, 0, 10), 7);
  EXPECT_EQ(entry.number("z", 3, 0, 10), 3) << "null is absent";
  EXPECT_EQ(entry.integer("i", 7, 0, 10), 4);
  EXPECT_EQ(entry.integer("none", 7, 0, 10), 7);
  EXPECT_TRUE(entry.flag("f", false));
  EXPECT_TRUE(entry.flag("none", true));
  EXPECT_EQ(entry.text("s", "y"), "x");
  EXPECT_EQ(entry.text("none", "y"), "y");
  EXPECT_EQ(entry.choice("c", "a", {"a", "b"}), "b");
  EXPECT_EQ(entry.choice("none", "a", {"a", "b"}), "a");
  EXPECT_THAT(entry.numbers("l", 2), ElementsAre(1, 2));
  EXPECT_THAT(entry.color("rgb", {}), ElementsAre(1.0, 128 / 255.0, 0.0));
  EXPECT_THAT(entry.color("none", {0.1, 0.2, 0.3}), ElementsAre(0.1, 0.2, 0.3));
  EXPECT_TRUE(entry.has("n"));
  EXPECT_FALSE(entry.has("z"));
  EXPECT_NO_THROW(entry.finish());
  EXPECT_EQ(entry.folder(), "folder");
}

TEST(JsonEntry, LimitsBelongToTheRange) {
  JsonEntry entry = entryOf(R"({"a": 1, "b": 3})");
  EXPECT_EQ(entry.number("a", {}, 1, 3), 1);
  EXPECT_EQ(entry.number("b", {}, 1, 3), 3);
  for (const std::string text : {R"({"a": 0.999})", R"({"a": 3.001})"})
    EXPECT_THAT(entryError(text, [](JsonEntry& e) { e.number("a", {}, 1, 3); }),
                HasSubstr("folder/w.json: robot.a: must be a number in [1, 3]"));
}

TEST(JsonEntry, EveryWrongKindOfValueIsRefused) {
  EXPECT_THAT(entryError("{}", [](JsonEntry& e) { e.number("a", {}, 1, 3); }), HasSubstr("robot.a: is missing"));
  EXPECT_THAT(entryError(R"({"a": "1"})", [](JsonEntry& e) { e.number("a", 2, 1, 3); }),
              HasSubstr("must be a number, is \"1\""));
  EXPECT_THAT(entryError(R"({"a": 1.5})", [](JsonEntry& e) { e.integer("a", 2, 1, 3); }), HasSubstr("whole number"));
  EXPECT_THAT(entryError(R"({"a": 1})", [](JsonEntry& e) { e.flag("a", false); }), HasSubstr("true or false, is 1"));
  EXPECT_THAT(entryError(R"({"a": 1})", [](JsonEntry& e) { e.text("a", ""); }), HasSubstr("must be a text"));
  EXPECT_THAT(entryError("{}", [](JsonEntry& e) { e.text("a", {}); }), HasSubstr("robot.a: is missing"));
  EXPECT_THAT(entryError(R"({"a": "noth"})", [](JsonEntry& e) { e.choice("a", {}, {"north", "south"}); }),
              AllOf(HasSubstr("unknown 'noth'"), HasSubstr("did you mean 'north'"), HasSubstr("south")));
  for (const std::string text : {R"({"a": [1, 2, 3]})", R"({"a": 1})", "{}"})
    EXPECT_THAT(entryError(text, [](JsonEntry& e) { e.numbers("a", 2); }), HasSubstr("a list of 2 numbers"));
  EXPECT_THAT(entryError(R"({"a": [1, 1001]})", [](JsonEntry& e) { e.numbers("a", 2); }), HasSubstr("within 1000 m"));
  for (const std::string code : {"ff8000", "#ff80", "#ff80zz", "#ff80001"})
    EXPECT_THAT(entryError("{\"a\": \"" + code + "\"}", [](JsonEntry& e) { e.color("a", {}); }),
                AllOf(HasSubstr("\"#rrggbb\""), HasSubstr(code)));
  EXPECT_THAT(test::messageOf<ConfigError>([] { entryOf("[1]", "rooms[2]"); }),
              HasSubstr("rooms[2]: must be an object"));
  EXPECT_THAT(test::messageOf<ConfigError>([] { entryOf("[1]", ""); }), HasSubstr("w.json: the world: must be"));
}

TEST(JsonEntry, PathsAreListsOfPoints) {
  JsonEntry entry = entryOf(R"({"path": [[1, 2], [3, -4]]})");
  EXPECT_THAT(entry.path("path"), ElementsAre(Eigen::Vector2d(1, 2), Eigen::Vector2d(3, -4)));
  for (const std::string text : {"{}", R"({"p": []})", R"({"p": 3})"})
    EXPECT_THAT(entryError(text, [](JsonEntry& e) { e.path("p"); }), HasSubstr("robot.p: must be a list of points"));
  EXPECT_THAT(entryError(R"({"p": [[1, 2], [1, 2, 3]]})", [](JsonEntry& e) { e.path("p"); }), HasSubstr("robot.p[1]"));
}

TEST(JsonEntry, ChildrenKnowTheirPlaceAndUnknownKeysAreFound) {
  JsonEntry entry = entryOf(R"({"wall": {"colour": 1}, "doors": [{"a": 1}, {"b": 1}]})", "rooms[1]");
  JsonEntry wall = entry.child("wall");
  EXPECT_EQ(wall.place("size_m"), "rooms[1].wall.size_m");
  EXPECT_EQ(wall.place(), "rooms[1].wall");
  wall.color("color", {});
  EXPECT_THAT(test::messageOf<ConfigError>([&] { wall.finish(); }),
              AllOf(HasSubstr("rooms[1].wall.colour: unknown key"), HasSubstr("did you mean 'color'")));
  auto doors = entry.children("doors");
  ASSERT_EQ(doors.size(), 2u);
  EXPECT_EQ(doors[1].place("b"), "rooms[1].doors[1].b");
  EXPECT_EQ(doors[1].number("b", {}, 0, 2), 1);
  EXPECT_TRUE(entry.children("none").empty());
  EXPECT_FALSE(entry.child("none").has("a"));
  EXPECT_NO_THROW(entry.finish());
  EXPECT_THAT(test::messageOf<ConfigError>([&] { entry.children("wall"); }), HasSubstr("must be a list"));
}

}  // namespace
}  // namespace roomgraph
