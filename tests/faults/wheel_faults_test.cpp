// SPDX-License-Identifier: BSD-3-Clause
// Wheels that stand, and kidnapped robots: poses against increments multiplied by hand.
#include "wheel_faults.h"

#include <gmock/gmock.h>

#include <numbers>

#include "passing_records.h"

namespace roomgraph {
namespace {

using namespace test;
using ::testing::ElementsAre;

void expectPose(const PassingRecord& record, double x, double y, double yaw) {
  EXPECT_NEAR(odometryOf(record).x(), x, 1e-12);
  EXPECT_NEAR(odometryOf(record).y(), y, 1e-12);
  EXPECT_NEAR(odometryOf(record).phi(), yaw, 1e-12);
}

// Straight on, a turn to the left while the wheels stand, straight on: the turn is missing.
const double kQuarter = std::numbers::pi / 2;
PassingRecords drive() {
  return {odometryAt(0, 0), odometryAt(1, 1), odometryAt(2, 2, 0, kQuarter), odometryAt(3, 2, 1, kQuarter),
          odometryAt(4, 2, 3, kQuarter)};
}

TEST(LiftedWheelsFault, StandsStillInTheWindowAndGoesOnFromThere) {
  LiftedWheelsFault fault({1.5, 2.5});
  const auto out = through(fault, drive());
  ASSERT_EQ(out.size(), 5u);
  EXPECT_TRUE(keepsBytes(out[1]));
  expectPose(out[2], 1, 0, 0);
  expectPose(out[3], 2, 0, 0);  // 1 m ahead of where it stood
  expectPose(out[4], 4, 0, 0);
  EXPECT_EQ(fault.counts(), (Counts{{"ODOMETRY", 3}}));
}

TEST(LiftedWheelsFault, LeavesOtherSensorsAndReadingsThatAreNoNumbersAlone) {
  LiftedWheelsFault fault({0, 10});
  PassingRecord broken = odometryAt(2, 0);
  dynamic_cast<mrpt::obs::CObservationOdometry&>(*broken.observation).odometry.x(std::nan(""));
  const auto out = through(fault, {scanAt(0), odometryAt(1, 1), broken, odometryAt(3, 2)});
  EXPECT_TRUE(keepsBytes(out[0]));
  EXPECT_TRUE(std::isnan(odometryOf(out[2]).x()));
  expectPose(out[3], 1, 0, 0);
}

TEST(KidnapFault, NoSensorSeesTheWayAndTheWheelsDidNotTurn) {
  KidnapFault fault({1.5, 3.5});
  PassingRecords records = drive();
  records.insert(records.begin() + 3, scanAt(2.5));
  records.push_back(imagesAt(4.5));
  const auto out = through(fault, records);
  EXPECT_THAT(stampsOf(out), ElementsAre(0, 1, 4, 4.5));
  expectPose(out[1], 1, 0, 0);
  expectPose(out[2], 3, 0, 0);  // the 2 m after the last reading of the window
  EXPECT_EQ(fault.counts(), (Counts{{"LASER", 1}, {"ODOMETRY", 2}}));
}

}  // namespace
}  // namespace roomgraph
