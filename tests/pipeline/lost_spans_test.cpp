// SPDX-License-Identifier: BSD-3-Clause
// LostSpans: lost records in a row, silences between records and at both ends of a run.
#include "roomgraph/pipeline/lost_spans.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace roomgraph::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

StepReport reportOf(StepReport::Kind kind, double t, const std::string& note) {
  StepReport report;
  report.kind = kind;
  report.t = t;
  report.note = note;
  return report;
}

class Lost : public ::testing::Test {
 protected:
  void frame(double t, const std::string& note = "") {
    spans_.onStep(reportOf(StepReport::Kind::kFrame, t, note));
  }
  void scan(double t, const std::string& note = "") {
    spans_.onStep(reportOf(StepReport::Kind::kScan, t, note));
  }
  void other(double t) { spans_.onStep(reportOf(StepReport::Kind::kOther, t, "")); }

  // "camera 1 to 2: 3 x cause"
  std::vector<std::string> found() const {
    std::vector<std::string> out;
    for (const auto& span : spans_.spans()) {
      char text[200];
      std::snprintf(text, sizeof text, "%s %g to %g: %d x %s", span.sensor.c_str(), span.from, span.to,
                    span.records, span.why.c_str());
      out.push_back(text);
    }
    return out;
  }

  LostSpans spans_;
};

TEST_F(Lost, RecordsInARowAreOneSpanUntilTheNextGoodOne) {
  for (int i = 0; i < 10; ++i) frame(100 + i, i >= 3 && i < 6 ? "not tracked: too few matches" : "");
  EXPECT_THAT(found(), ElementsAre("camera 103 to 106: 3 x too few matches"));
}

TEST_F(Lost, EachReasonAndEachSensorHasItsOwn) {
  for (int i = 0; i < 6; ++i) {
    frame(10 + i, i == 2 ? "not tracked: dark" : i == 3 ? "not tracked: blurred" : "");
    scan(10.5 + i, i == 2 || i == 5 ? "scan not matched: too few returns" : "");
  }
  EXPECT_THAT(found(),
              ElementsAre("camera 12 to 13: 1 x dark", "lidar 12.5 to 13.5: 1 x too few returns",
                          "camera 13 to 14: 1 x blurred", "lidar 15.5 to 15.5: 1 x too few returns"));
}

TEST_F(Lost, ASilenceIsLongerThanASecondAndThanTenUsualSpacings) {
  for (const double t : {0.1, 0.2, 0.3, 1.2, 1.3, 2.4, 2.5}) scan(t);
  EXPECT_THAT(found(), ElementsAre("lidar 1.3 to 2.4: 0 x no record")) << "0.9 s are none";
}

TEST_F(Lost, SlowSensorsMayBeSilentForLonger) {
  for (const double t : {1., 3., 5., 7., 20., 41., 43.}) frame(t);
  EXPECT_THAT(found(), ElementsAre("camera 20 to 41: 0 x no record")) << "ten spacings are 20 s";
}

// The other sensors and the odometry say how long the run was; what was left out has no time.
TEST_F(Lost, ASensorThatBeginsLateAndEndsEarlyIsSilent) {
  other(0);
  other(50);
  for (int i = 0; i < 5; ++i) frame(52 + i / 10.);
  other(60);
  EXPECT_THAT(found(), ElementsAre("camera 50 to 52: 0 x no record", "camera 52.4 to 60: 0 x no record"));
}

TEST_F(Lost, NothingOfASensorThatIsNotThere) {
  for (int i = 0; i < 30; ++i) scan(i / 10.);
  EXPECT_THAT(found(), IsEmpty());
  EXPECT_EQ(spans_.text(), "");
}

TEST_F(Lost, LinesHoldWhatTheSpansSay) {
  frame(1.5, "not tracked: dark \"\xff\"");
  frame(1.75);
  const auto line = nlohmann::json::parse(spans_.text());
  EXPECT_EQ(line["sensor"], "camera");
  EXPECT_EQ(line["from"], 1.5);
  EXPECT_EQ(line["to"], 1.75);
  EXPECT_EQ(line["records"], 1);
  EXPECT_THAT(line["why"].get<std::string>(), ::testing::StartsWith("dark \""));
}

}  // namespace
}  // namespace roomgraph::test
