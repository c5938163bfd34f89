// SPDX-License-Identifier: BSD-3-Clause
// INI parser: sections, comments, quotes, duplicates, and errors with their place.
#include "roomgraph/core/ini_text.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using ::testing::HasSubstr;
using test::messageOf;

TEST(IniText, SectionsEntriesCommentsAndPlaces) {
  const auto entries = parseIni(
      "# head\n"
      "free = 1\n"
      "[ first ]\r\n"
      "  key = value with spaces   # comment\n"
      "color = #00ff00\n"
      "; comment\n"
      "\n"
      "equation = a=b ; note\n"
      "empty =\n"
      "[second]\n"
      "key=2\n",
      "c.ini");
  ASSERT_EQ(entries.size(), 6u);
  EXPECT_EQ(entries[0].section, "");
  EXPECT_EQ(entries[0].place, "c.ini:2");
  EXPECT_EQ(entries[1].section, "first");
  EXPECT_EQ(entries[1].key, "key");
  EXPECT_EQ(entries[1].value, "value with spaces");
  EXPECT_EQ(entries[1].place, "c.ini:4");
  EXPECT_EQ(entries[2].value, "#00ff00");
  EXPECT_EQ(entries[3].value, "a=b");
  EXPECT_EQ(entries[3].place, "c.ini:8");
  EXPECT_EQ(entries[4].value, "");
  EXPECT_EQ(entries[5].section, "second");
}

TEST(IniText, ColourKeepsItsHash) {
  EXPECT_EQ(parseIni("color = #e6862a   # orange\n", "c.ini").at(0).value, "#e6862a");
  EXPECT_EQ(parseIni("color=#e6862a;\n", "c.ini").at(0).value, "#e6862a;");
  EXPECT_EQ(parseIni("file = a;b#c\n", "c.ini").at(0).value, "a;b#c");
  EXPECT_EQ(parseIni("empty = # comment\n", "c.ini").at(0).value, "");
  EXPECT_EQ(parseIni("empty = #\r\n", "c.ini").at(0).value, "");
  EXPECT_EQ(parseIni("number = 1 #comment\n", "c.ini").at(0).value, "1");
  EXPECT_TRUE(parseIni("# color = #e6862a\n", "c.ini").empty());
}

TEST(IniText, LastLineNeedsNoNewline) {
  EXPECT_EQ(parseIni("[a]\nk = 1", "c.ini").at(0).value, "1");
}

TEST(IniText, AByteOrderMarkIsNoSection) {
  const auto entries = parseIni("\xef\xbb\xbf[a]\nk = 1\n", "c.ini");
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(entries[0].section, "a");
}

TEST(IniText, DuplicatesNameBothPlaces) {
  const auto message =
      messageOf<ConfigError>([] { parseIni("[a]\nk = 1\n[b]\nk = 1\n[a]\nk = 2\n", "c.ini"); });
  EXPECT_THAT(message, HasSubstr("c.ini:6: [a] k is set twice, first at c.ini:2"));
}

TEST(IniText, LinesThatAreNothing) {
  for (const char* line : {"word\n", "= 3\n", "[open\n"})
    EXPECT_THAT(messageOf<ConfigError>([&] { parseIni(line, "c.ini"); }), HasSubstr("c.ini:1: expected"))
        << line;
}

TEST(IniText, Files) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("a.ini", "[a]\nk = 1\n");
  EXPECT_EQ(parseIniFile(file).at(0).place, file.string() + ":2");
  EXPECT_THAT(messageOf<InputError>([&] { parseIniFile(folder.path() / "none.ini"); }),
              HasSubstr("none.ini"));
}

}  // namespace
}  // namespace roomgraph
