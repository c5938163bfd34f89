// SPDX-License-Identifier: BSD-3-Clause
// What is said of sensors that contradict others and of sensors that are turned.
#include "movement_findings.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace roomgraph::test {
namespace {

using testing::HasSubstr;

std::optional<Movement> seenAs(double x, double y) {
  Vector6d sigma;
  sigma << 0.005, 0.005, 0.5, 0.5, 0.5, 0.005;
  return Movement{toPose3(Pose2{x, y, 0}), Matrix6d(sigma.cwiseAbs2().asDiagonal())};
}

const auto kStraight = seenAs(0.3, 0), kTurned = seenAs(0.3 * std::cos(0.2), 0.3 * std::sin(0.2));

std::vector<Finding> findingsOf(const MovementBySensor& seen, int times) {
  MovementAgreement agreement;
  for (int i = 0; i < times; ++i) agreement.compare(100 + i, 100.5 + i, seen);
  return movementFindings(agreement);
}

TEST(MovementFindings, NothingIsSaidOfSensorsThatAgree) { EXPECT_TRUE(findingsOf({kStraight, kStraight, kStraight}, 30).empty()); }

TEST(MovementFindings, AContradictionIsANoteUntilItLasts) {
  const auto once = findingsOf({kStraight, kStraight, seenAs(0, 0)}, 1);
  ASSERT_EQ(once.size(), 1u);
  EXPECT_EQ(once[0].severity, Severity::kNote);
  EXPECT_EQ(once[0].place, "wheels");
  EXPECT_EQ(once[0].what, "contradicts both other sensors for 0.5 s, first from t = 100.000 s on, by up to 0.30 m and 0.0 deg");
  const auto often = findingsOf({kStraight, kStraight, seenAs(0, 0)}, 4);
  ASSERT_EQ(often.size(), 1u);
  EXPECT_EQ(often[0].severity, Severity::kWarning);
  EXPECT_THAT(often[0].what, HasSubstr("sensors 4 times, for 2.0 s, first"));
}

TEST(MovementFindings, OfTwoAWarningLastsTwoSecondsAtOnce) {
  MovementAgreement agreement;
  const MovementBySensor seen = {std::nullopt, kStraight, seenAs(0, 0)};
  for (int i = 0; i < 8; ++i) agreement.compare(100 + i, 100.5 + i, seen);
  const auto often = movementFindings(agreement);
  ASSERT_EQ(often.size(), 1u);
  EXPECT_EQ(often[0].severity, Severity::kNote);
  EXPECT_EQ(often[0].place, "camera and wheels");
  EXPECT_EQ(often[0].what, "contradict each other 8 times, for 4.0 s, first from t = 100.000 s on, by up to 0.30 m and 0.0 deg");
  EXPECT_EQ(often[0].hint, "one of them is wrong: pictures full of what moves or repeats mislead, or wheels slip or are lifted, or the robot is pushed");
  for (int i = 0; i < 4; ++i) agreement.compare(200 + 0.5 * i, 200.5 + 0.5 * i, seen);
  EXPECT_EQ(movementFindings(agreement)[0].severity, Severity::kWarning);
}

TEST(MovementFindings, TheOneThatIsTurnedIsNamedOrBothWhereOnlyTheyAreThere) {
  const std::string its_way = "its way is turned by 11.5 deg (+- 0.0) against that of ";
  for (const auto& [seen, place, what] :
       {std::tuple(MovementBySensor{kStraight, kTurned, kStraight}, "camera", its_way + "wheels and lidar"),
        {MovementBySensor{kTurned, kStraight, kStraight}, "lidar", its_way + "wheels and camera"},
        {MovementBySensor{std::nullopt, kTurned, kStraight}, "camera", its_way + "wheels"},
        {MovementBySensor{kTurned, std::nullopt, kStraight}, "lidar", its_way + "wheels"},
        {MovementBySensor{kStraight, kTurned, std::nullopt}, "camera and lidar", "their ways are turned by 11.5 deg (+- 0.0) against each other"}}) {
    const auto findings = findingsOf(seen, 25);
    ASSERT_FALSE(findings.empty()) << place;
    EXPECT_EQ(findings[0].severity, Severity::kWarning);
    EXPECT_EQ(findings[0].place, place);
    EXPECT_EQ(findings[0].what, what);
    EXPECT_EQ(std::count_if(findings.begin(), findings.end(), [](const Finding& one) { return one.what.find("turned") != std::string::npos; }), 1) << place;
  }
}

TEST(MovementFindings, WheelsThatDriveSidewaysBlameNeither) {
  for (const Finding& finding : findingsOf({kStraight, kStraight, kTurned}, 25)) EXPECT_THAT(finding.what, testing::Not(HasSubstr("turned"))) << finding.place;
}

}  // namespace
}  // namespace roomgraph::test
