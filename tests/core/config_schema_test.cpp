// SPDX-License-Identifier: BSD-3-Clause
// Configuration schema: unknown sections and keys, suggestions, Markdown reference.
#include "roomgraph/core/config_schema.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "example_stages.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using test::messageOf;
using ::testing::Not;

struct Volume : Configurable {
  double level_db = 60;
  void declareParameters(ParameterVisitor& v) override {
    v.add("level_db", level_db, {.doc = "how loud", .unit = "dB", .max = 120});
  }
};

ConfigSchema schema() {
  ConfigSchema out;
  PoliteGreeter greeter;
  CurtGreeter curt;
  Volume volume;
  out.add("greeting", greeter, "PoliteGreeter");
  out.add("greeting", curt, "CurtGreeter");
  out.add("greeting", volume);
  out.add("sound", volume);
  out.describe("greeting", "What is said.");
  return out;
}

std::string complaint(const std::string& text) {
  return messageOf<ConfigError>([&] { schema().check(Config::fromText(text, "c.ini")); });
}

TEST(ConfigSchema, AcceptsKeysOfAnyClassOfTheSection) {
  EXPECT_NO_THROW(
      schema().check(Config::fromText("[greeting]\nloud = true\nlevel_db = 3\n[sound]\nlevel_db = 1\n")));
  EXPECT_NO_THROW(schema().check(Config()));
}

TEST(ConfigSchema, UnknownSection) {
  EXPECT_THAT(complaint("[greting]\nloud = true\n"),
              AllOf(HasSubstr("c.ini:2: unknown section [greting]"), HasSubstr("did you mean 'greeting'?"),
                    HasSubstr("known sections: greeting, sound")));
  EXPECT_THAT(complaint("[zzzzzzzzzzzz]\na = 1\n"), Not(HasSubstr("did you mean")));
}

TEST(ConfigSchema, UnknownKey) {
  EXPECT_THAT(complaint("[greeting]\nloud = true\npause = 1\n"),
              AllOf(HasSubstr("c.ini:3: [greeting] has no key 'pause' (value '1')"),
                    HasSubstr("did you mean 'pause_s'?"), HasSubstr("known keys: loud, times, pause_s")));
  EXPECT_THAT(complaint("[sound]\nloud = true\n"), HasSubstr("has no key 'loud'"))
      << "a key of another section";
  EXPECT_THAT(complaint("loose = 1\n"), HasSubstr("c.ini:1: unknown section []"));
}

TEST(ConfigSchema, MarkdownNamesEverything) {
  const auto page = schema().markdown();
  EXPECT_THAT(page, HasSubstr("## [greeting]\nWhat is said.\n"));
  EXPECT_THAT(page,
              HasSubstr("| `times` | `2` | a whole number in [1, 5] |  | how often | `PoliteGreeter` |"));
  EXPECT_THAT(page, HasSubstr("| `pause_s` | `0.5` | a number >= 0 | s | between two greetings |"));
  EXPECT_THAT(page, HasSubstr("| `level_db` | `60` | a number <= 120 | dB | how loud |  |"));
  EXPECT_THAT(page, HasSubstr("| `language` | `en` | one of en, de |"));
  EXPECT_THAT(page, HasSubstr("## [sound]\n"));
}

TEST(ConfigSchema, AKeyOfSeveralClassesIsOneLine) {
  Volume volume;
  ConfigSchema out;
  out.add("sound", volume, "Trumpet");
  out.add("sound", volume, "Violin");
  volume.level_db = 30;
  out.add("sound", volume, "Lute");
  const auto page = out.markdown();
  EXPECT_THAT(page,
              HasSubstr("| `level_db` | `60` | a number <= 120 | dB | how loud | `Trumpet`, `Violin` |"));
  EXPECT_THAT(page, HasSubstr("| `level_db` | `30` | a number <= 120 | dB | how loud | `Lute` |"))
      << "another default is another line";
}

}  // namespace
}  // namespace roomgraph
