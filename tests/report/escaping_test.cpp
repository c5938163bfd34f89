// SPDX-License-Identifier: BSD-3-Clause
// Texts of a run that would be markup or no UTF-8 stay texts in the page.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "made_up_run.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kNasty = "</script><script>alert(1)</script><!-- \"' & \\ \n]]>";

int timesIn(const std::string& text, const std::string& part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(ReportEscaping, NamesAreTextsWhateverTheyHold) {
  const TemporaryFolder folder;
  writeRun(folder);
  json content = json::parse(folder.read("landmarks.json"));
  content["landmarks"][0]["class"] = kNasty;
  content["landmarks"][0]["class_posterior"] = {{kNasty, 1}};
  content["recording"] = kNasty;
  folder.write("landmarks.json", content.dump());
  folder.write("config.ini", std::string("[a]\nx = </script><b>\n"));
  const ReportPage page = makeReport({{{folder.path(), kNasty}}, {}, {}});
  const std::string text = dataText(page.html);
  EXPECT_THAT(text, Not(HasSubstr("<")));
  const json run = json::parse(text).at("runs").at(0);
  EXPECT_EQ(run["name"], kNasty);
  EXPECT_EQ(run["recording"], kNasty);
  EXPECT_EQ(run["objects"][0]["class"], kNasty);
  EXPECT_TRUE(run["objects"][0]["posterior"].contains(kNasty));
  EXPECT_EQ(run["config"][0]["value"], "</script><b>");
  EXPECT_EQ(timesIn(page.html, "</script>"), 2) << "that of the data, and that of the page's own script";
}

TEST(ReportEscaping, WhatIsNoUtf8IsRepaired) {
  const TemporaryFolder folder;
  writeRun(folder);
  folder.write("config.ini", "[a]\nx = caf\xe9 \xff\n");
  const json run = dataOf(makeReport({{{folder.path(), "out/\xe9t\xe9"}}, {}, {}})).at("runs").at(0);
  EXPECT_EQ(run["name"], "out/\xef\xbf\xbdt\xef\xbf\xbd");
  EXPECT_THAT(run["config"][0]["value"].get<std::string>(), HasSubstr("\xef\xbf\xbd"));
}

TEST(ReportEscaping, ThePageForbidsItselfEveryRequest) {
  const TemporaryFolder folder;
  writeRun(folder);
  const std::string html = reportOf(folder).html;
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
  EXPECT_THAT(
      html,
      HasSubstr("default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"));
  for (const char* reference : {"http://", "https://", " src=", "@import", "url(", "<link"}) {
    const int allowed = std::string(reference) == "http://" ? 1 : 0;  // the name of SVG's namespace
    EXPECT_EQ(timesIn(html, reference), allowed) << reference;
  }
  for (const char* mark : {"/*STYLES*/", "/*DATA*/", "/*SCRIPTS*/"}) EXPECT_THAT(html, Not(HasSubstr(mark)));
  EXPECT_THAT(html, HasSubstr("prefers-color-scheme"));
  EXPECT_THAT(html, Not(HasSubstr("innerHTML")));
}

}  // namespace
}  // namespace roomgraph::test
