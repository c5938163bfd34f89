// SPDX-License-Identifier: BSD-3-Clause
// Angles, largest ranges, places and clocks that a log leaves open, against closed forms.
#include "carmen_survey.h"

#include <gmock/gmock.h>

#include <cmath>

#include "carmen_maker.h"
#include "errors_of.h"
#include "roomgraph/core/errors.h"

namespace roomgraph::carmen {
namespace {

using namespace roomgraph::test;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kDegrees = M_PI / 180;

Survey surveyOf(const std::vector<std::string>& lines) {
  Survey survey;
  for (const auto& line : lines) {
    const auto message = parseLine(line);
    EXPECT_TRUE(message) << line << ": " << message.reason();
    survey.take(*message);
  }
  return survey;
}

LogPlan planOf(const std::vector<std::string>& lines, const CarmenImportOptions& options = {}) {
  return planLog(surveyOf(lines), options, "x.log");
}

// First and last beam in degrees.
std::pair<double, double> beams(const ScannerPlan& scanner, std::size_t readings) {
  const auto angles = assumedAngles(scanner, readings);
  return {angles.start / kDegrees,
          (angles.start + angles.step * static_cast<double>(readings - 1)) / kDegrees};
}

TEST(CarmenSurvey, BeamsOfTheSickLms) {
  using ::testing::DoubleNear;
  using ::testing::Pair;
  const auto near = [](double a, double b) { return Pair(DoubleNear(a, 1e-9), DoubleNear(b, 1e-9)); };
  EXPECT_THAT(beams({}, 181), near(-90, 90));
  EXPECT_THAT(beams({}, 361), near(-90, 90));
  EXPECT_THAT(beams({}, 180), near(-90, 89));
  EXPECT_THAT(beams({}, 360), near(-90, 89.5));
  ScannerPlan by_step;
  by_step.step = 0.25 * kDegrees;
  EXPECT_THAT(beams(by_step, 401), near(-50, 50));
  ScannerPlan by_view;
  by_view.field_of_view = 240 * kDegrees;
  EXPECT_THAT(beams(by_view, 180), near(-120, 120));
}

TEST(CarmenSurvey, CodesOfTheSickLmsAreNoRanges) {
  EXPECT_DOUBLE_EQ(maxRange(8.191f, 1), 8.183);
  EXPECT_DOUBLE_EQ(maxRange(81.91f, 1), 81.83);
  EXPECT_DOUBLE_EQ(maxRange(81.83f, 1), 81.83);
  EXPECT_DOUBLE_EQ(maxRange(32.767f, 1), 32.759);
  EXPECT_NEAR(maxRange(50, 5), 50, 1e-9);
  EXPECT_LT(maxRange(50, 5), 50.0000001) << "itself is none";
  EXPECT_GT(maxRange(12.5f, 1), 12.5) << "a wall";
}

TEST(CarmenSurvey, PlaceOfTheScannerIsThatOfThePoses) {
  const auto lines = [](double ahead) {
    std::vector<std::string> all;
    for (int k = 0; k < 20; ++k) {
      const Pose2 robot{0.1 * k, 0.05 * k, 0.3 * k};
      const Pose2 laser = robot * Pose2{ahead, 0.02, 0.1};
      all.push_back(format("FLASER 2 1 2 %.9f %.9f %.9f %.9f %.9f %.9f %d h %d", laser.x, laser.y, laser.yaw,
                           robot.x, robot.y, robot.yaw, k, k));
    }
    return all;
  };
  const auto place = planOf(lines(0.2)).scanners.at("FLASER").robot_from_laser;
  EXPECT_NEAR(place.x, 0.2, 1e-6);
  EXPECT_NEAR(place.y, 0.02, 1e-6);
  EXPECT_NEAR(place.yaw, 0.1, 1e-6);
}

std::vector<std::string> standingSweeps(const std::vector<std::string>& first = {}) {
  std::vector<std::string> all = first;
  for (int k = 0; k < 8; ++k) all.push_back(format("FLASER 2 1 2 %d 0 0 %d 0 0 %d h %d", k, k, k + 100, k));
  return all;
}

TEST(CarmenSurvey, ParametersPlaceWhatPosesDoNot) {
  const auto plan = planOf(standingSweeps({"PARAM robot_frontlaser_offset 0.15"}));
  EXPECT_DOUBLE_EQ(plan.scanners.at("FLASER").robot_from_laser.x, 0.15);
  EXPECT_THAT(plan.warnings, IsEmpty());
  const auto odd = planOf(standingSweeps({"PARAM robot_frontlaser_offset here"}));
  EXPECT_DOUBLE_EQ(odd.scanners.at("FLASER").robot_from_laser.x, 0);
}

TEST(CarmenSurvey, StepOfTheParametersIsUsedWhereItCanBe) {
  auto plan = planOf(standingSweeps({"PARAM laser_front_laser_resolution 0.5"}));
  EXPECT_NEAR(plan.scanners.at("FLASER").step.value(), 0.5 * kDegrees, 1e-12);
  plan = planOf(standingSweeps({"PARAM laser_front_laser_resolution 200"}));
  EXPECT_FALSE(plan.scanners.at("FLASER").step);
}

TEST(CarmenSurvey, CorrectedPosesAreToldAndUsedOnRequest) {
  std::vector<std::string> lines;
  for (int k = 0; k < 20; ++k)
    lines.push_back(format("FLASER 2 1 2 %.3f %.3f 0 %d 0 0 %d h %d", 0.9 * k, 0.1 * k, k, k + 100, k));
  const auto plan = planOf(lines);
  EXPECT_THAT(plan.warnings, Contains(HasSubstr("another program has corrected them")));
  EXPECT_TRUE(plan.scanners.at("FLASER").corrected);
  EXPECT_EQ(plan.truth, "");
  EXPECT_EQ(planOf(lines, {.corrected_as_truth = true}).truth, "FLASER");
  EXPECT_THAT(messageOf<ConfigError>([] { planOf(standingSweeps(), {.corrected_as_truth = true}); }),
              HasSubstr("no corrected poses in it"));
}

TEST(CarmenSurvey, SweepsThatKnowMostAreUsed) {
  auto lines = standingSweeps();
  lines.push_back("RAWLASER1 0 -1.57 3.14 1.57 80 0 0 2 1 2 0 100 h 1");
  EXPECT_THAT(planOf(lines).scanners, ElementsAre(::testing::Key("FLASER")));
  lines.push_back("ROBOTLASER1 0 -1.57 3.14 1.57 80 0 0 2 1 2 0 0 0 0 0 0 0 0 0 0 0 0 100 h 1");
  EXPECT_THAT(planOf(lines).scanners, ElementsAre(::testing::Key("ROBOTLASER1")));
  const auto raw =
      planOf({"RAWLASER1 0 -1.57 3.14 1.57 80 0 0 2 1 2 0 100 h 1", "ODOM 0 0 0 0 0 0 100.5 h 1"});
  EXPECT_THAT(raw.warnings, Contains(HasSubstr("RAWLASER1: has no poses")));
  EXPECT_EQ(raw.odometry, "ODOM");
}

TEST(CarmenSurvey, OdometryThatMovesIsUsed) {
  auto lines = standingSweeps();  // eight that move
  for (int k = 0; k < 20; ++k) lines.push_back(format("ODOM 0 0 0 0 0 0 %d h %d", 100 + k, k));
  EXPECT_EQ(planOf(lines).odometry, "FLASER") << "ODOM was never filled in";
  lines.push_back("ODOM 1 0 0 0 0 0 200 h 100");
  EXPECT_EQ(planOf(lines).odometry, "ODOM") << "there are more of them";
}

TEST(CarmenSurvey, ClocksThatDisagreeAreTold) {
  auto lines = standingSweeps();
  for (int k = 0; k < 8; ++k) lines.push_back(format("ODOM %d 0 0 0 0 0 %d h %d", k, k + 103, k));
  for (int k = 0; k < 8; ++k) lines.push_back(format("TRUEPOS %d 0 0 0 0 0 %d h %d", k, k + 103, k));
  EXPECT_THAT(planOf(lines).warnings, ElementsAre(HasSubstr("FLASER: clock is 3.00 s behind those")));
  EXPECT_THAT(planOf(lines, {.times = CarmenTimes::kLogger}).warnings, IsEmpty());
  EXPECT_THAT(planOf(standingSweeps()).warnings, IsEmpty());
}

TEST(CarmenSurvey, ClocksThatDriftOrJumpAreTold) {
  std::vector<std::string> lines;
  for (int k = 0; k < 40; ++k) lines.push_back(format("ODOM %d 0 0 0 0 0 %.2f h %d", k, 1.01 * k + 100, k));
  EXPECT_THAT(planOf(lines).warnings, Contains(HasSubstr("ODOM: clock drifts by 0.3")));
  auto jump = standingSweeps();
  jump.push_back("FLASER 2 1 2 9 0 0 9 0 0 90 h 9");
  EXPECT_THAT(planOf(jump).warnings,
              Contains(HasSubstr("FLASER: the clock jumps back by more than a second 1 times")));
}

TEST(CarmenSurvey, LoggerStandsInForAClockThatStandsStill) {
  std::vector<std::string> lines;
  for (int k = 0; k < 5; ++k) lines.push_back(format("ODOM %d 0 0 0 0 0 0 h %d.5", k, k));
  const auto plan = planOf(lines);
  EXPECT_TRUE(plan.by_logger);
  EXPECT_THAT(plan.warnings, Contains(HasSubstr("ipc_timestamp does not advance")));
  EXPECT_THAT(messageOf<InputError>([] {
                planOf({"ODOM 0 0 0 0 0 0 5", "ODOM 1 0 0 0 0 0 5"});
              }),
              HasSubstr("all messages have the same time stamp"));
  EXPECT_THAT(messageOf<ConfigError>([] {
                planOf({"ODOM 0 0 0 0 0 0 5", "ODOM 1 0 0 0 0 0 6"}, {.times = CarmenTimes::kLogger});
              }),
              HasSubstr("has no logger_timestamp"));
}

TEST(CarmenSurvey, NothingUsableIsAnErrorThatNamesWhatIsThere) {
  EXPECT_THAT(messageOf<InputError>([] {
                planOf({"NMEAGGA 1", "# FLASER"});
              }),
              HasSubstr("x.log: no message of a CARMEN log that can be used"));
  EXPECT_THAT(messageOf<InputError>([] { planOf({"NMEAGGA 1"}); }), HasSubstr("there is: NMEAGGA"));
  EXPECT_THAT(messageOf<ConfigError>([] {
                planOf(standingSweeps(), {.sensor_poses = {{"LASER", {}}}});
              }),
              HasSubstr("--pose LASER: no such scanner is imported; there is: FLASER"));
}

}  // namespace
}  // namespace roomgraph::carmen
