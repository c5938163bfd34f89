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

}  // namespace
}  // namespace roomgraph::test
