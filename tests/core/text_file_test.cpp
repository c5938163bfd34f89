// SPDX-License-Identifier: BSD-3-Clause
// Text files, and JSON errors with line and column.
#include "roomgraph/core/text_file.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "errors_of.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string refusal(const std::string& text) {
  return test::messageOf<InputError>([&] { parseJson<json>(text, "x.json"); });
}

TEST(TextFile, NamesWhyItCannotBeRead) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(readTextFile(folder.write("a.txt", "one\ntwo")), "one\ntwo");
  EXPECT_EQ(readTextFile(folder.write("empty.txt", "")), "");
  EXPECT_THAT(test::messageOf<InputError>([&] { readTextFile(folder.file("none")); }),
              HasSubstr("none: cannot be opened: no such file"));
  EXPECT_THAT(test::messageOf<InputError>([&] { readTextFile(folder.path()); }),
              HasSubstr(": cannot be opened: is a folder"));
}

TEST(Json, ProblemsHaveLineAndColumnAndNoTagOfTheLibrary) {
  EXPECT_EQ(parseJson<json>("{\"a\": 1}", "x.json").at("a"), 1);
  EXPECT_THAT(refusal("{\n  \"a\": 1,\n  b\n}"),
              AllOf(HasSubstr("x.json: not valid JSON: line 3, column 3: "), Not(HasSubstr("exception"))));
  EXPECT_THAT(refusal("{\"a\": }"), HasSubstr("x.json: not valid JSON: column 7: "));
  EXPECT_EQ(refusal(" \n"), "x.json: is empty");
  EXPECT_THROW((parseJson<json, ConfigError>("[", "x.json")), ConfigError);
}

TEST(Json, NumbersThatNoDoubleHoldsAreNamed) {
  EXPECT_EQ(refusal("{\n\"a\": 1,\n\"b\": 1e999}"),
            "x.json: not valid JSON: line 3, column 6: the number 1e999 is too large");
  EXPECT_EQ(refusal("[1e999]"), "x.json: not valid JSON: column 2: the number 1e999 is too large");
}

TEST(FirstLine, LeavesOutTheTagsOfLibraries) {
  EXPECT_EQ(firstLine(std::runtime_error("==== MRPT exception ====\nMessage:  no such thing\nLocation: x")),
            "no such thing");
  EXPECT_EQ(firstLine(std::runtime_error("[json.exception.type_error.302] type must be number")),
            "type must be number");
  EXPECT_EQ(firstLine(std::runtime_error("one\ntwo")), "one");
  EXPECT_EQ(firstLine(std::runtime_error("")), "unknown error");
}

}  // namespace
}  // namespace roomgraph
