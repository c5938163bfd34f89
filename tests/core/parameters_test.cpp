// SPDX-License-Identifier: BSD-3-Clause
// Parsing and formatting of parameter values: ranges, choices, lists, quoting round trips.
#include "roomgraph/core/parameters.h"

#include <gmock/gmock.h>

#include <limits>

#include "errors_of.h"

namespace roomgraph {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using test::messageOf;

template <class T>
T parsed(const std::string& text, const ParameterInfo& info = {}) {
  T value{};
  parseParameter(text, info, value);
  return value;
}

template <class T>
std::string refused(const std::string& text, const ParameterInfo& info = {}) {
  return messageOf<std::invalid_argument>([&] { parsed<T>(text, info); });
}

TEST(Parameters, Bools) {
  for (const char* text : {"true", "1", "yes", "on"}) EXPECT_TRUE(parsed<bool>(text));
  bool value = true;
  for (const char* text : {"false", "0", "no", "off"}) {
    parseParameter(text, {}, value);
    EXPECT_FALSE(value);
  }
  EXPECT_EQ(refused<bool>("maybe"), "true or false");
  EXPECT_EQ(refused<bool>(""), "true or false");
}

TEST(Parameters, NumbersRefuseRestsAndNonsense) {
  EXPECT_EQ(parsed<int>("-12"), -12);
  EXPECT_EQ(parsed<double>("1e-3"), 1e-3);
  for (const char* text : {"", "x", "1.5", "3 m", "99999999999"})
    EXPECT_EQ(refused<int>(text), "a whole number") << text;
  for (const char* text : {"", "1,5", "0.5m", "nan", "inf", "1e999"})
    EXPECT_EQ(refused<double>(text), "a number") << text;
}

TEST(Parameters, RangesAreInclusive) {
  const ParameterInfo share{.doc = "", .min = 0, .max = 1};
  EXPECT_EQ(parsed<double>("0", share), 0);
  EXPECT_EQ(parsed<double>("1", share), 1);
  EXPECT_EQ(refused<double>("1.0001", share), "a number in [0, 1]");
  EXPECT_EQ(refused<double>("-0.1", share), "a number in [0, 1]");
  EXPECT_EQ(refused<int>("0", {.doc = "", .min = 1}), "a whole number >= 1");
  EXPECT_EQ(refused<int>("6", {.doc = "", .max = 5}), "a whole number <= 5");
}

TEST(Parameters, ChoicesAndLists) {
  const ParameterInfo info{.doc = "", .choices = {"a", "b"}};
  EXPECT_EQ(parsed<std::string>("b", info), "b");
  EXPECT_EQ(refused<std::string>("c", info), "one of a, b");
  EXPECT_THAT(parsed<std::vector<std::string>>(" a ,b,, "), ElementsAre("a", "b"));
  EXPECT_THAT(parsed<std::vector<std::string>>(""), ::testing::IsEmpty());
  EXPECT_EQ(refused<std::vector<std::string>>("a, c", info), "one of a, b");
}

TEST(Parameters, FormattedValuesReadBackExactly) {
  for (const double value : {0.1, -1.0 / 3, 1e300, 5e-324, 0.0, 123456789.125})
    EXPECT_EQ(parsed<double>(formatParameter(value)), value);
  EXPECT_EQ(formatParameter(0.1), "0.1");
  for (const int value : {0, -7, std::numeric_limits<int>::max()})
    EXPECT_EQ(parsed<int>(formatParameter(value)), value);
  EXPECT_TRUE(parsed<bool>(formatParameter(true)));
  const std::vector<std::string> list = {"Ann", "Bob B"};
  EXPECT_EQ(parsed<std::vector<std::string>>(formatParameter(list)), list);
}

TEST(Parameters, QuotesOnlyWhereTheyAreNeeded) {
  EXPECT_EQ(formatParameter(std::string("/a b/c;d#e,f\\g.txt")), "/a b/c;d#e,f\\g.txt");
  EXPECT_EQ(formatParameter(std::string("#e6862a")), "#e6862a");
  EXPECT_EQ(formatParameter(std::string("a #1, b")), R"("a #1, b")");
  EXPECT_EQ(formatParameter(std::string(R"(" \ )")), R"("\" \\ ")");
  EXPECT_EQ(formatParameter(std::vector<std::string>{"a", "b, c", "d"}), R"(a, "b, c", d)");
  EXPECT_THAT(parsed<std::vector<std::string>>(R"( "a, b" ,c,"", "d")"), ElementsAre("a, b", "c", "", "d"));
  EXPECT_EQ(parsed<std::string>(R"(say "a")"), R"(say "a")") << "a quote inside is a character";
  for (const char* text : {R"(")", R"("a)", R"("a" b)", R"("a\")", R"("\x")"}) {
    EXPECT_THAT(refused<std::string>(text), HasSubstr("double quotes")) << text;
    EXPECT_THAT(refused<std::vector<std::string>>("c, " + std::string(text)), HasSubstr("double quotes"))
        << text;
  }
}

}  // namespace
}  // namespace roomgraph
