// SPDX-License-Identifier: BSD-3-Clause
// The page about a batch: what it shows, what it links, what it escapes.
#include "roomgraph/catalogue/figure_page.h"

#include <gmock/gmock.h>

#include "made_up_results.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(BatchPage, LinksTheReportsThatAreThere) {
  const TemporaryFolder folder;
  Catalogue catalogue = Catalogue::forWriting(folder.file("c"));
  for (int seed = 1; seed <= 3; ++seed) {
    catalogue.import(madeUpResult("a lab", seed, "default"), "");
    catalogue.import(madeUpResult("a lab", seed, "no_lidar"), "");
  }
  RunResult failed = madeUpResult("<hall>", 1, "default");
  failed.status = "failed";
  failed.reason = "5 < 6 & \"so\"";
  catalogue.import(failed, "");
  std::filesystem::create_directories(folder.path() / "runs" / "a lab_s2--default");
  std::ofstream(folder.path() / "runs" / "a lab_s2--default" / "report.html") << "x";
  const std::string page = batchPage(catalogue, {}, {"batch & co", folder.path() / "runs", "runs"});
  EXPECT_THAT(page, HasSubstr("<title>batch &amp; co</title>"));
  EXPECT_THAT(page, HasSubstr("href=\"runs/a%20lab_s2--default/report.html\""));
  EXPECT_THAT(page, Not(HasSubstr("a%20lab_s1--default/report.html")));
  EXPECT_THAT(page, HasSubstr("5 &lt; 6 &amp; &quot;so&quot;"));
  EXPECT_THAT(page, Not(HasSubstr("<hall>")));
  EXPECT_THAT(page, HasSubstr("Differences from default"));
  EXPECT_THAT(page, HasSubstr("7 runs: 6 complete, 1 failed"));
  EXPECT_THAT(page, Not(HasSubstr("<h2>a lab</h2>"))) << "the only group with complete runs";
  catalogue.import(madeUpResult("shed", 1, "default"), "");
  const std::string groups = batchPage(catalogue, {}, {"two", folder.path() / "runs", "runs"});
  EXPECT_THAT(groups, HasSubstr("<h2>a lab</h2>"));
  EXPECT_THAT(groups, Not(HasSubstr("<h2>shed</h2>"))) << "one input alone";
  EXPECT_THAT(page, Not(HasSubstr("://"))) << "it loads nothing";
}

// What a group is compared with is what the page says, where the group has it.
TEST(BatchPage, GroupsHaveTheBaselineThatWasAskedFor) {
  const TemporaryFolder folder;
  Catalogue catalogue = Catalogue::forWriting(folder.file("c"));
  for (int seed = 1; seed <= 2; ++seed) {
    for (const char* variant : {"default", "fast", "zoom"}) catalogue.import(madeUpResult("home", seed, variant), "");
    for (const char* variant : {"default", "fast"}) catalogue.import(madeUpResult("office", seed, variant), "");
  }
  ComparisonChoice choice;
  choice.baseline = "zoom";
  const std::string page = batchPage(catalogue, choice, {"t", folder.path(), "runs"});
  const auto home = page.find("<h2>home</h2>"), office = page.find("<h2>office</h2>");
  ASSERT_TRUE(home != std::string::npos && office != std::string::npos);
  const auto first = [&](std::size_t from) {
    return std::min({page.find("default", from), page.find("fast", from), page.find("zoom", from)});
  };
  EXPECT_EQ(first(home), page.find("zoom", home));
  EXPECT_THAT(page.substr(office), HasSubstr("the difference from default is significant"));
  EXPECT_THAT(page.substr(home, office - home), Not(HasSubstr("difference from")));
}

// On an axis of 116 px from 2 px on, over both variants: 0 to 4.
TEST(BatchPage, DrawsAllVariantsOnOneScale) {
  const TemporaryFolder folder;
  Catalogue catalogue = Catalogue::forWriting(folder.file("c"));
  const auto add = [&](const std::string& variant, int seed, double ate) {
    RunResult r = madeUpResult("lab", seed, variant);
    r.figures = {{"trajectory.ate_rmse_m", ate}};
    catalogue.import(r, "");
  };
  for (int seed = 0; seed <= 2; ++seed) {
    add("default", seed, seed);
    add("far", seed, 2 + seed);
  }
  const std::string page = batchPage(catalogue, {}, {"t", folder.path(), "runs"});
  EXPECT_THAT(page, HasSubstr("x1=\"2.0\" x2=\"60.0\" y1=\"6\""));
  EXPECT_THAT(page, HasSubstr("<rect x=\"16.5\" y=\"2\" width=\"29.0\""));
  EXPECT_THAT(page, HasSubstr("class=\"middle\" x1=\"31.0\""));
  EXPECT_THAT(page, HasSubstr("x1=\"60.0\" x2=\"118.0\" y1=\"6\""));
  EXPECT_THAT(page, HasSubstr("class=\"middle\" x1=\"89.0\""));
}

TEST(BatchPage, ListsTheFirstTwoThousandRuns) {
  const TemporaryFolder folder;
  Catalogue catalogue = Catalogue::forWriting(folder.file("c"));
  for (int seed = 1; seed <= 2005; ++seed) catalogue.import(madeUpResult("lab", 10000 + seed, "default"), "");
  const std::string page = batchPage(catalogue, {}, {"t", folder.path(), "runs"});
  EXPECT_THAT(page, HasSubstr("The first 2000 of 2005."));
  EXPECT_THAT(page, HasSubstr("lab_s12000--default"));
  EXPECT_THAT(page, Not(HasSubstr("lab_s12001--default")));
}

// Every tag that is opened is closed, in order; what a browser would otherwise guess at.
TEST(BatchPage, IsWellFormed) {
  const TemporaryFolder folder;
  Catalogue catalogue = Catalogue::forWriting(folder.file("c"));
  for (int seed = 1; seed <= 3; ++seed)
    for (const char* variant : {"default", "a<b"}) catalogue.import(madeUpResult("la&b", seed, variant), "");
  const std::string page = batchPage(catalogue, {}, {"t", folder.path(), "runs"});
  std::vector<std::string> open;
  for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at + 1)) {
    const std::size_t end = page.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const std::string tag = page.substr(at + 1, page.find_first_of(" >/", at + 2) - at - 1);
    if (page[at + 1] == '!' || page[end - 1] == '/' || tag == "meta") continue;
    if (page[at + 1] != '/') {
      open.push_back(tag);
      continue;
    }
    ASSERT_FALSE(open.empty());
    EXPECT_EQ("/" + open.back(), page.substr(at + 1, end - at - 1));
    open.pop_back();
  }
  EXPECT_TRUE(open.empty());
}

}  // namespace
}  // namespace roomgraph::test
