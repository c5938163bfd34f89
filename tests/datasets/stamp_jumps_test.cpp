// SPDX-License-Identifier: BSD-3-Clause
// Clocks that jump in the order of the file, gaps, slow sensors, and stamps that are corrected from a jump on.
#include "stamp_jumps.h"

#include <gmock/gmock.h>

#include "record_correction.h"

namespace roomgraph::test {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::Field;

/// Records of a fast and a slow sensor in the order in which they happened.
struct Stream {
  StampJumps jumps;
  double expected_s = 0;
  std::vector<double> jumped_since;  ///< true times of the slow sensor's records that count as behind a jump

  void add(double from_t, double until_t, double late_s, bool fast = true) {
    for (int tick = static_cast<int>(std::lround(from_t * 20)); tick < static_cast<int>(std::lround(until_t * 20)); ++tick) {
      const double t = tick / 20.0;
      if (fast) jumps.add("wheels", t, 0);
      if (tick % 4 == 0 && jumps.add("camera", t + late_s, expected_s)) jumped_since.push_back(t);
    }
  }
};

TEST(StampJumps, AJumpIsFoundAndCountsUntilTheClockJumpsBack) {
  for (const double late_s : {0.5, -0.5}) {
    Stream stream{.expected_s = late_s};
    stream.add(0, 10, 0);
    stream.add(10, 11, late_s);
    stream.add(11, 20, 0);
    EXPECT_THAT(stream.jumps.found().at("camera"), ElementsAre(Field(&StampJump::seconds, DoubleNear(late_s, 1e-6)),
                                                               Field(&StampJump::seconds, DoubleNear(-late_s, 1e-6))));
    EXPECT_NEAR(stream.jumps.found().at("camera")[0].t, 10 + late_s, 1e-6);
    EXPECT_THAT(stream.jumped_since, ElementsAre(10, 10.2, 10.4, 10.6, 10.8));
    EXPECT_FALSE(stream.jumps.jumped("camera"));
    EXPECT_FALSE(stream.jumps.found().contains("wheels"));
  }
}

TEST(StampJumps, AnotherJumpIsFoundButNotTheExpectedOne) {
  Stream stream{.expected_s = 0.5};
  stream.add(0, 10, 0);
  stream.add(10, 20, 0.25);
  EXPECT_EQ(stream.jumps.found().at("camera").size(), 1u);
  EXPECT_TRUE(stream.jumped_since.empty());
}

TEST(StampJumps, GapsAreNoJumps) {
  Stream stream{.expected_s = 0.5};
  stream.add(0, 10, 0);
  for (int tick = 200; tick < 210; ++tick) stream.jumps.add("wheels", tick / 20.0, 0);  // half a second without the camera
  stream.add(10.6, 14, 0);
  stream.add(14, 15, 0, false);  // without wheels
  stream.add(15, 20, 0);
  EXPECT_TRUE(stream.jumps.found().empty());
  EXPECT_TRUE(stream.jumped_since.empty());
}

// The first that goes on leads the others by the pause, and seems to jump: which counts only where such a jump is expected.
TEST(StampJumps, APauseOfAllLooksLikeAJumpOfTheFirstThatGoesOn) {
  for (const double expected_s : {-0.6, 0.3, 0.0}) {
    Stream stream{.expected_s = expected_s};
    stream.add(0, 10, 0);
    EXPECT_FALSE(stream.jumps.add("camera", 10.6, expected_s)) << expected_s;
    stream.add(10.65, 20, 0);
    EXPECT_EQ(stream.jumps.found().at("camera").size(), 1u);
    EXPECT_TRUE(stream.jumped_since.empty()) << expected_s;
  }
}

TEST(StampJumps, ASlowSensorBesideAFastOneIsNoJump) {
  StampJumps jumps;
  for (int i = 0; i < 60; ++i) {
    if (i % 5 == 0) jumps.add("lidar", 0.1 * i, 0.5);
    jumps.add("camera", 0.1 * i + 0.01, 0.5);
  }
  EXPECT_TRUE(jumps.found().empty());
  EXPECT_FALSE(jumps.jumped("lidar"));
  EXPECT_FALSE(jumps.jumped("a sensor that is not there"));
}

TEST(StampJumps, StampsAreCorrectedFromTheJumpOnAndBoxesWithTheirImages) {
  RecordCorrection correction({.time_offsets_s = {{"KINECT", 0.1}}, .time_jumps_s = {{"KINECT", -0.5}}});
  for (int tick = 0; tick < 80; ++tick) {
    const double t = tick / 20.0, stamp = t < 2 ? t : t + 0.5;
    Record reading = OdometryReading{.t = t};
    correction.apply(reading);
    EXPECT_EQ(timeOf(reading), t);
    if (tick % 4 != 0) continue;
    Frame frame;
    frame.t = stamp;
    frame.sensor_label = "KINECT";
    Record seen = frame;
    correction.apply(seen);
    EXPECT_NEAR(timeOf(seen), t + 0.1, 1e-6);
    auto boxes = std::make_shared<CObservationDetections>();
    boxes->image_label = "KINECT";
    boxes->timestamp = mrpt::Clock::fromDouble(stamp);
    Record detected = boxes;
    correction.apply(detected);
    EXPECT_NEAR(timeOf(detected), t + 0.1, 1e-6);
  }
  EXPECT_THAT(correction.jumps().at("KINECT"), ElementsAre(Field(&StampJump::seconds, DoubleNear(0.5, 1e-6))));
}

TEST(StampJumps, WheelsAreCorrectedFromTheJumpOn) {
  RecordCorrection correction({.wheels_time_jump_s = 0.4});
  for (int tick = 0; tick < 80; ++tick) {
    const double t = tick / 20.0;
    Record scan = Scan{.t = t};
    correction.apply(scan);
    Record reading = OdometryReading{.t = t < 2 ? t : t - 0.4};
    correction.apply(reading);
    EXPECT_NEAR(timeOf(reading), t, 1e-6);
  }
  EXPECT_THAT(correction.jumps().at("odometry"), ElementsAre(Field(&StampJump::seconds, DoubleNear(-0.4, 1e-6))));
}

}  // namespace
}  // namespace roomgraph::test
