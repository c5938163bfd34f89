// SPDX-License-Identifier: BSD-3-Clause
// Lines of the display of a batch.
#include "display.h"

#include <gmock/gmock.h>

#include <sstream>

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(BatchDisplays, ShowBarsAndClocks) {
  EXPECT_EQ(clockText(62.4), "1:02");
  EXPECT_EQ(clockText(3723), "1:02:03");
  EXPECT_EQ(taskLine({"lab", 0.5, 12}, 5), "lab    [############............]  50 %  0:12");
  EXPECT_EQ(taskLine({"a_long_name", 1, 0}, 6), "a_long  [########################] 100 %  0:00");
  EXPECT_THAT(taskLine({"made", -1, 3}, 4), Not(HasSubstr("%")));
}

TEST(BatchDisplays, ReckonTheTimeLeftFromWhatWasDone) {
  // 3 done and two halves in 40 s: 10 s each. 10 - 2 from before - 4 = 4 left.
  EXPECT_EQ(totalsLine({3, 0, 2, 10, 2, 0}, {{"a", 0.5, 1}, {"b", 0.5, 1}}, 40),
            "5 of 10 runs complete (2 from before); 2 running; 0:40, about 0:40 left");
  EXPECT_EQ(totalsLine({3, 1, 0, 4}, {}, 40), "3 of 4 runs complete, 1 failed; 0 running; 0:40");
  EXPECT_EQ(totalsLine({0, 0, 0, 900, 40, 860}, {}, 40),
            "0 of 900 runs complete; 40 running; 860 queued; 0:40");
}

TEST(BatchDisplays, WithoutATerminalEventsAreLinesAndNothingElse) {
  std::ostringstream out;
  BatchDisplay display({&out, false});
  display.event("start a");
  display.draw({0, 0, 0, 1}, {{"a", 0.1, 1}});
  display.event("complete a");
  EXPECT_EQ(out.str(), "start a\ncomplete a\n");
}

TEST(BatchDisplays, OnATerminalEventsStayAboveTheDisplay) {
  std::ostringstream out;
  {
    BatchDisplay display({&out, true});
    display.draw({0, 0, 0, 1}, {{"a", 0.1, 1}});
    display.event("complete a");
  }
  EXPECT_THAT(out.str(), HasSubstr("0 of 1 runs complete"));
  EXPECT_THAT(out.str(), HasSubstr("\033[2A\033[Jcomplete a\n")) << "two lines are taken back first";
}

TEST(BatchDisplays, SilentMeansSilent) {
  BatchDisplay display({nullptr, true});
  display.event("x");
  display.draw({}, {});
}

}  // namespace
}  // namespace roomgraph::test
