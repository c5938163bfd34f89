// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/core/config.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "example_stages.h"
#include "roomgraph/core/errors.h"
#include "temp_file.h"

namespace roomgraph {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::messageOf;
using ::testing::Pair;

TEST(Config, ReadsDeclaredKeysAndKeepsOtherDefaults) {
  const auto config =
      Config::fromText("[greeting]\nloud = yes\ntimes = 4\nnames = Eve\n[other]\ntimes = 1\n");
  PoliteGreeter greeter;
  config.read("greeting", greeter);
  EXPECT_TRUE(greeter.loud);
  EXPECT_EQ(greeter.times, 4);
  EXPECT_EQ(greeter.pause_s, 0.5);
  EXPECT_EQ(greeter.language, "en");
  EXPECT_THAT(greeter.names, ElementsAre("Eve"));
}

TEST(Config, BadValuesNamePlaceSectionKeyValueAndRange) {
  PoliteGreeter greeter;
  const auto message = [&](const std::string& line) {
    return messageOf<ConfigError>(
        [&] { Config::fromText("[greeting]\n" + line, "my.ini").read("greeting", greeter); });
  };
  EXPECT_EQ(message("times = 9"),
            "my.ini:2: [greeting] times = '9' is not allowed; allowed: a whole number in [1, 5]");
  EXPECT_THAT(message("pause_s = -1"), AllOf(HasSubstr("pause_s = '-1'"), HasSubstr("a number >= 0")));
  EXPECT_THAT(message("language = fr"), HasSubstr("one of en, de"));
  EXPECT_THAT(message("loud = loudly"), HasSubstr("true or false"));
}

TEST(Config, OverridesWinAndAreNamedAsPlace) {
  auto config = Config::fromText("[greeting]\ntimes = 1\n");
  config.override("greeting.times=3");
  config.override("greeting.pause_s=1");
  config.override("greeting.pause_s=2");
  config.override("greeting.language=a=b.c");
  EXPECT_EQ(config.text("greeting", "times", ""), "3");
  EXPECT_EQ(config.text("greeting", "pause_s", ""), "2");
  EXPECT_EQ(config.text("greeting", "language", ""), "a=b.c");
  EXPECT_EQ(config.text("greeting", "absent", "fallback"), "fallback");
  EXPECT_EQ(config.entries().size(), 3u);
  PoliteGreeter greeter;
  EXPECT_THAT(messageOf<ConfigError>([&] { config.read("greeting", greeter); }),
              HasSubstr("--set: [greeting] language"));
}

TEST(Config, MalformedOverrides) {
  Config config;
  for (const char* text : {"", "key", "section.key", "=1", ".key=1", "section.=1", "key=a.b"})
    EXPECT_THAT(messageOf<ConfigError>([&] { config.override(text); }),
                HasSubstr("expected section.key=value"))
        << text;
  EXPECT_TRUE(config.entries().empty());
}

TEST(Config, CurrentValuesReadBack) {
  PoliteGreeter greeter;
  greeter.times = 5;
  greeter.names = {"X"};
  const auto values = currentValues(greeter);
  EXPECT_THAT(values, ElementsAre(Pair("loud", "false"), Pair("times", "5"), Pair("pause_s", "0.5"),
                                  Pair("language", "en"), Pair("names", "X")));
  std::string text = "[greeting]\n";
  for (const auto& [key, value] : values) text += key + " = " + value + "\n";
  PoliteGreeter copy;
  Config::fromText(text).read("greeting", copy);
  EXPECT_EQ(currentValues(copy), values);
}

TEST(Config, MissingFile) {
  const testing::TempFolder folder;
  EXPECT_THROW(Config::fromFile(folder.path() / "none.ini"), InputError);
}

}  // namespace
}  // namespace roomgraph
