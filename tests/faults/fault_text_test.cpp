// SPDX-License-Identifier: BSD-3-Clause
// Values of faults: what is understood, and what is refused with which words.
#include "fault_text.h"

#include <gmock/gmock.h>

#include <cmath>

#include "fault_kinds.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

using enum FaultySensor;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

FaultText textOf(const std::string& value) {
  return {"fault", value, "PATTERN"};
}

template <class Call>
void refuses(const Call& call, const std::string& text) {
  EXPECT_THAT(call, ThrowsMessage<ConfigError>(HasSubstr(text))) << text;
  EXPECT_THAT(call, ThrowsMessage<ConfigError>(HasSubstr("--fault "))) << text;
}

TEST(FaultText, Windows) {
  const auto both = textOf("1.5:20").window();
  EXPECT_EQ(both.from_s, 1.5);
  EXPECT_EQ(both.to_s, 20);
  EXPECT_TRUE(both.contains(1.5));
  EXPECT_FALSE(both.contains(20));
  EXPECT_TRUE(std::isinf(textOf("3:").window().to_s));
  EXPECT_EQ(textOf(":3").window().from_s, 0);
  refuses([] { textOf("3").window(); }, "'3' is not a span of time; expected PATTERN");
  refuses([] { textOf(":").window(); }, "no time in it");
  refuses([] { textOf("1:2:3").window(); }, "is not a span of time");
  refuses([] { textOf("a:3").window(); }, "'a' is not a number");
  refuses([] { textOf("1:nan").window(); }, "'nan' is not a number");
  refuses([] { textOf("-1:3").window(); }, "begins before the recording");
  refuses([] { textOf("3:3").window(); }, "ends before it begins");
}

TEST(FaultText, Sensors) {
  FaultText named = textOf("lidar=1:2");
  EXPECT_EQ(named.takeSensors({kCamera, kLidar}), StruckSensors{kLidar});
  EXPECT_EQ(named.window().to_s, 2);
  EXPECT_EQ(textOf("1:2").takeSensors({kCamera, kOther}), (StruckSensors{kCamera, kOther}));
  refuses([] { textOf("lidr=1:2").takeSensors({kLidar}); }, "no sensor 'lidr' (did you mean 'lidar'?)");
  refuses([] { textOf("odometry=1:2").takeSensors({kLidar}); }, "does not strike the odometry");
  refuses([] { textOf("1,2,3,4,5,6").takeSensor(); }, "names no sensor");
}

TEST(FaultText, NumbersBehindTimes) {
  EXPECT_EQ(textOf("1:2").windowAndNumber(4).second, 4);
  EXPECT_EQ(textOf("1:2:0.5").windowAndNumber(4).second, 0.5);
  refuses([] { textOf("1:2:0").windowAndNumber(4); }, "must be above 0");
  EXPECT_EQ(textOf("2:-1.5").timeAndShift(), std::pair(2.0, -1.5));
  EXPECT_EQ(textOf("2:+1.5").timeAndShift(), std::pair(2.0, 1.5));
  refuses([] { textOf("2:0").timeAndShift(); }, "no fault");
  refuses([] { textOf("2:1e12").timeAndShift(); }, "more than 30 years");
  refuses([] { textOf("2").timeAndShift(); }, "is not a time and a shift");
  EXPECT_EQ(textOf("7").time(), 7);
  refuses([] { textOf("").time(); }, "'' is not a number");
}

TEST(FaultText, PosesWithAndWithoutWindow) {
  FaultText text = textOf("camera=0.1,0,0,90,0,0@5:6");
  EXPECT_EQ(text.takeSensor(), kCamera);
  const FaultWindow window = text.takeWindowAtEnd();
  EXPECT_EQ(window.from_s, 5);
  EXPECT_EQ(window.to_s, 6);
  const Pose3 pose = text.pose();
  EXPECT_NEAR(pose.translation().x(), 0.1, 1e-12);
  EXPECT_NEAR(logSO3(pose.linear()).z(), 90 * kDegree, 1e-12);
  EXPECT_TRUE(textOf("0,0,0,1,0,0").takeWindowAtEnd().contains(1e9));
  refuses([] { textOf("1,2").pose(); }, "2 numbers instead of 6");
  refuses([] { textOf("0,0,0,0,0,0").pose(); }, "no fault");
  refuses([] { textOf("1:2:11").windowAndNumber(1, 10); }, "must not be above 10");
  refuses([] { textOf("1:2:0").windowAndNumber(1, 10); }, "must be above 0");
  refuses([] { textOf("1,0,0,0,0,0@5").takeWindowAtEnd(); }, "behind '@'");
}

TEST(FaultKinds, EachIsMadeOfAValueOfItsPattern) {
  const std::map<std::string, std::string> values{
      {"A:B", "1:2"},
      {"A", "1"},
      {"[SENSOR=]A:B", "odometry=1:2"},
      {"[SENSOR=]A:SECONDS", "1:-2"},
      {"[SENSOR=]A:B[:FACTOR]", "camera=1:2:3"},
      {"A:B[:SPEED]", "1:2:0.5"},
      {"SENSOR=x,y,z,yaw,pitch,roll[@A:B]", "lidar=0,0,1,0,0,0@1:2"}};
  for (const auto& kind : faultKinds()) {
    ASSERT_TRUE(values.contains(kind.value)) << kind.value;
    EXPECT_TRUE(makeFault({kind.name, values.at(kind.value)}, Random(1))) << kind.name;
    EXPECT_THROW(makeFault({kind.name, "x"}, Random(1)), ConfigError) << kind.name;
    EXPECT_FALSE(kind.what.empty());
  }
}

}  // namespace
}  // namespace roomgraph
