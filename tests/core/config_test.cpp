// SPDX-License-Identifier: BSD-3-Clause
// Config: values, ranges, overrides, quoting round trips and file names.
#include "roomgraph/core/config.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "example_stages.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/mentioned_files.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using test::messageOf;
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

class Texts : public Configurable {
 public:
  void declareParameters(ParameterVisitor& v) override {
    v.add("text", text, {.doc = ""});
    v.add("list", list, {.doc = ""});
    v.add("after", after, {.doc = ""});
  }
  std::string text, after;
  std::vector<std::string> list;
};

// Every text of up to four of the characters that mean something, alone and as an item of a list.
TEST(Config, AnyTextComesBackAsItWas) {
  const std::string special = "a \"\\#;,=[]\n\r\t";
  std::vector<std::string> nasty{""};
  for (std::size_t i = 0; nasty[i].size() < 4; ++i)
    for (const char c : special) nasty.push_back(nasty[i] + c);
  for (std::size_t i = 0; i < nasty.size(); ++i) {
    Texts written, read;
    written.text = nasty[i];
    written.after = "end";
    written.list = {nasty[i], "b", nasty[(i * 7919) % nasty.size()]};
    std::string lines = "[s]\n";
    for (const auto& [key, value] : currentValues(written)) lines += key + " = " + value + "\n";
    Config::fromText(lines).read("s", read);
    ASSERT_EQ(read.text, written.text) << lines;
    ASSERT_EQ(read.list, written.list) << lines;
    ASSERT_EQ(read.after, "end") << lines;
  }
}

TEST(Config, QuotesHideCommentsOnlyWhereTheyOpen) {
  Texts read;
  const auto config = Config::fromText(
      "[s]\ntext = \"a # b\" # comment\nlist = c, \"d ; e\", f\"g # comment\nafter = 5\" #\n");
  config.read("s", read);
  EXPECT_EQ(read.text, "a # b");
  EXPECT_THAT(read.list, ElementsAre("c", "d ; e", "f\"g"));
  EXPECT_EQ(read.after, "5\"");
  EXPECT_EQ(config.text("s", "text", ""), "a # b");
  EXPECT_THAT(
      messageOf<ConfigError>([&] { Config::fromText("[s]\ntext = \"a # b\n", "c.ini").read("s", read); }),
      AllOf(HasSubstr("c.ini:2"), HasSubstr("double quotes")));
}

TEST(Config, MentionedFilesAreTextsAndItems) {
  const auto config = Config::fromText("[s]\ntext = \"a #1, b\"\nlist = c, \"d, e\"\n");
  const auto files = mentionedFiles(config);
  EXPECT_THAT(files, ::testing::IsSupersetOf<std::filesystem::path>({"a #1, b", "c", "d, e"}));
  const auto networks = mentionedFiles(Config::fromText("[s]\nlist = me@home/a.onnx:yolox @ 5, b.onnx@2, me@home/c.onnx:yolox\n"));
  EXPECT_THAT(networks, ::testing::IsSupersetOf<std::filesystem::path>({"me@home/a.onnx", "b.onnx", "me@home/c.onnx"}));
}

class Files : public Configurable {
 public:
  void declareParameters(ParameterVisitor& v) override {
    v.add("one", one, {.doc = "", .file = true});
    v.add("more", more, {.doc = "", .file = true});
    v.add("text", text, {.doc = ""});
  }
  std::string one, text;
  std::vector<std::string> more;
};

// A relative name is meant from where it was written: in a file its folder, on the command line here.
TEST(Config, NamesOfFilesAreCompleted) {
  const test::TemporaryFolder folder;
  auto config = Config::fromFile(folder.write("c.ini", "[s]\none = ../x.onnx\nmore = y, /z\ntext = ../x\n"));
  Files read;
  config.read("s", read);
  EXPECT_EQ(read.one, (folder.path().parent_path() / "x.onnx").string());
  EXPECT_THAT(read.more, ElementsAre((folder.path() / "y").string(), "/z"));
  EXPECT_EQ(read.text, "../x");
  config.override("s.one=w");
  config.read("s", read);
  EXPECT_EQ(read.one, (std::filesystem::current_path() / "w").string());
}

TEST(Config, MissingFile) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(Config::fromFile(folder.path() / "none.ini"), InputError);
}

}  // namespace
}  // namespace roomgraph
