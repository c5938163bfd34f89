// SPDX-License-Identifier: BSD-3-Clause
// Lines written by hand after the header of CARMEN's logs.
#include "carmen_line.h"

#include <gmock/gmock.h>

namespace roomgraph::carmen {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kFront = "FLASER 3 1.5 2.25 81.91 1.1 2.0 0.25 1.0 2.0 0.25 976052857.337 robot 0.021";
const std::string kNew =
    "ROBOTLASER1 0 -1.57 3.14 0.0175 81.9 0.01 1 3 1.5 2.25 3 3 10 20 30 1.1 2 0.5 1 2 0.5 0.4 -0.1 0.5 0.6 "
    "0.7 1234.5 host 9.5";

template <class Content>
Content contentOf(const std::string& line) {
  const auto message = parseLine(line);
  EXPECT_TRUE(message) << message.reason();
  return std::get<Content>(message->content);
}

TEST(CarmenLine, OldSweepHasPosesButNoAngles) {
  const auto message = parseLine(kFront);
  ASSERT_TRUE(message) << message.reason();
  EXPECT_EQ(message->name, "FLASER");
  EXPECT_DOUBLE_EQ(message->stamps.ipc, 976052857.337);
  EXPECT_DOUBLE_EQ(message->stamps.logger.value(), 0.021);
  const auto sweep = std::get<Sweep>(message->content);
  EXPECT_FALSE(sweep.angles);
  EXPECT_THAT(sweep.ranges, ElementsAre(1.5f, 2.25f, 81.91f));
  EXPECT_DOUBLE_EQ(sweep.laser->x, 1.1);
  EXPECT_DOUBLE_EQ(sweep.robot->x, 1.0);
  EXPECT_DOUBLE_EQ(sweep.robot->yaw, 0.25);
}

TEST(CarmenLine, NewSweepHasAngles) {
  const auto sweep = contentOf<Sweep>(kNew);
  EXPECT_DOUBLE_EQ(sweep.angles->start, -1.57);
  EXPECT_DOUBLE_EQ(sweep.angles->field_of_view, 3.14);
  EXPECT_DOUBLE_EQ(sweep.angles->step, 0.0175);
  EXPECT_DOUBLE_EQ(sweep.angles->max_range_m, 81.9);
  EXPECT_THAT(sweep.remissions, ElementsAre(10, 20, 30));
  EXPECT_DOUBLE_EQ(sweep.laser->yaw, 0.5);
  EXPECT_DOUBLE_EQ(parseLine(kNew)->stamps.ipc, 1234.5);
  const auto raw =
      contentOf<Sweep>("RAWLASER12 0 -1.57 3.14 0.0175 81.9 0.01 0 2 1.5 2.25 0 1234.5 host 9.5");
  EXPECT_THAT(raw.ranges, ElementsAre(1.5f, 2.25f));
  EXPECT_FALSE(raw.laser);
  EXPECT_TRUE(raw.remissions.empty());
}

TEST(CarmenLine, OdometryTruthAndParameters) {
  const auto odometry = contentOf<Odometry>("ODOM 1 2 3.5 0.4 -0.2 0 10.5 host 0.5\r");
  EXPECT_DOUBLE_EQ(odometry.pose.x, 1);
  EXPECT_NEAR(odometry.pose.yaw, 3.5 - 2 * M_PI, 1e-12) << "angles lie in (-pi, pi]";
  EXPECT_DOUBLE_EQ(odometry.forward_m_s, 0.4);
  EXPECT_DOUBLE_EQ(odometry.turn_rad_s, -0.2);
  EXPECT_DOUBLE_EQ(contentOf<TruePose>("TRUEPOS 1 2 0.5 3 4 0.6 10.5 host 0.5").pose.y, 2);
  const auto parameter = contentOf<Parameter>("PARAM robot_frontlaser_offset 0.15 nohost 0");
  EXPECT_EQ(parameter.name, "robot_frontlaser_offset");
  EXPECT_EQ(parameter.value, "0.15 nohost 0");
}

TEST(CarmenLine, OthersAreNamedAndCommentsAreNone) {
  EXPECT_EQ(parseLine("NMEAGGA 1 2 3")->name, "NMEAGGA");
  EXPECT_TRUE(std::holds_alternative<std::monostate>(parseLine("ROBOTLASERS x")->content));
  for (const char* nothing : {"", "   ", "# FLASER 3 1 2", "\r"}) EXPECT_EQ(parseLine(nothing)->name, "");
}

TEST(CarmenLine, OldLogsMayLackHostAndLogger) {
  const auto without = parseLine("ODOM 1 2 3 0 0 0 10.5");
  ASSERT_TRUE(without) << without.reason();
  EXPECT_DOUBLE_EQ(without->stamps.ipc, 10.5);
  EXPECT_FALSE(without->stamps.logger);
  EXPECT_FALSE(parseLine("ODOM 1 2 3 0 0 0 10.5 host")->stamps.logger);
}

// Cut after any word before the time stamp, a line is refused, with the reason.
TEST(CarmenLine, CutOffAnywhereIsTold) {
  for (const auto& line : {kFront, kNew}) {
    const auto stamp = line.rfind(' ', line.rfind(' ', line.rfind(' ') - 1) - 1);
    for (auto end = line.find(' '); end <= stamp; end = line.find(' ', end + 1)) {
      const auto cut = parseLine(line.substr(0, end));
      ASSERT_FALSE(cut) << line.substr(0, end);
      EXPECT_THAT(cut.reason(), HasSubstr("ends before"));
    }
  }
}

TEST(CarmenLine, NumbersThatAreNoneAreTold) {
  EXPECT_EQ(parseLine("ODOM 1 2 x 0 0 0 10.5 host 0").reason(), "the pose is no number");
  EXPECT_EQ(parseLine("ODOM 1 2 nan 0 0 0 10.5 host 0").reason(), "the pose is not finite");
  EXPECT_EQ(parseLine("ODOM 1 2 3 0 0 0 inf host 0").reason(), "the time stamp is not finite");
  EXPECT_EQ(parseLine("FLASER -1 1 2 3 4 5 6 7 h 8").reason(), "num_readings is no count");
  EXPECT_EQ(parseLine("FLASER 1.5 1 2 3 4 5 6 7 h 8").reason(), "num_readings is no count");
  EXPECT_EQ(parseLine("FLASER 1e9 1 2 3 4 5 6 7 h 8").reason(), "num_readings is no count");
  EXPECT_EQ(parseLine("FLASER 0 1 2 3 4 5 6 7 h 8").reason(), "has no readings");
  EXPECT_TRUE(parseLine("FLASER 2 nan inf 2 3 4 5 6 7 8 h 9")) << "single ranges may be nothing";
}

}  // namespace
}  // namespace roomgraph::carmen
