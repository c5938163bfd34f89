// SPDX-License-Identifier: BSD-3-Clause
// Integers of JSON files: what is taken, and what is refused instead of being made something of.
#include "roomgraph/core/json_integer.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace roomgraph {
namespace {

using nlohmann::json;

TEST(JsonInteger, TakesWhatFits) {
  EXPECT_EQ(integerOf<int>(json::parse("7")), 7);
  EXPECT_EQ(integerOf<int>(json::parse("-2147483648")), -2147483647 - 1);
  EXPECT_EQ(integerOf<int>(json::parse("3.0")), 3);
  EXPECT_EQ(integerOf<int>(json::parse("2e3")), 2000);
  EXPECT_EQ(integerOf<std::int64_t>(json::parse("-9223372036854775808")),
            std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(integerOf<std::uint64_t>(json::parse("18446744073709551615")),
            std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(integerOf<std::int64_t>(json::parse("-9223372036854775808.0")),
            std::numeric_limits<std::int64_t>::min());
}

TEST(JsonInteger, RefusesTheRest) {
  for (const char* text :
       {"2147483648", "-2147483649", "1e300", "-1e300", "0.5", "\"7\"", "null", "[7]", "true"})
    EXPECT_THROW(integerOf<int>(json::parse(text)), json::type_error) << text;
  EXPECT_THROW(integerOf<std::int64_t>(json::parse("9223372036854775808")), json::type_error);
  EXPECT_THROW(integerOf<std::int64_t>(json::parse("9223372036854775808.0")), json::type_error);
  EXPECT_THROW(integerOf<std::uint64_t>(json::parse("-1")), json::type_error);
  EXPECT_THROW(integerOf<std::uint64_t>(json::parse("-1.0")), json::type_error);
}

TEST(JsonInteger, OfAMemberThatMayBeMissing) {
  const auto object = nlohmann::ordered_json::parse(R"({"width": 640, "height": "x"})");
  EXPECT_EQ(integerOf<int>(object, "width", 1), 640);
  EXPECT_EQ(integerOf<int>(object, "depth", 1), 1);
  EXPECT_THROW(integerOf<int>(object, "height", 1), nlohmann::ordered_json::type_error);
}

}  // namespace
}  // namespace roomgraph
