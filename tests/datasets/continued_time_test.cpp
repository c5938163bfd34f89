// SPDX-License-Identifier: BSD-3-Clause
// ContinuedTime: clocks of all sensors that are set back, against single sensors, swapped records, latency and pauses.
#include "continued_time.h"

#include <gmock/gmock.h>

#include <vector>

namespace roomgraph {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::Field;
using testing::IsEmpty;
using testing::SizeIs;

struct Sensor {
  const char* name;
  double interval_s, late_s = 0;  ///< of the records, and until they are in the file
  double back_s = 0, from_s = 0;  ///< its clock is set back, at the true time
};

struct Written {
  double written_s, t;  ///< when, and the stamp
  std::string sensor;
  double true_t;
};

std::vector<Written> recordingOf(const std::vector<Sensor>& sensors, double until_s) {
  std::vector<Written> out;
  for (const Sensor& sensor : sensors)
    for (int i = 0; i * sensor.interval_s < until_s; ++i) {
      const double t = i * sensor.interval_s;
      out.push_back({t + sensor.late_s, t >= sensor.from_s ? t - sensor.back_s : t, sensor.name, t});
    }
  std::stable_sort(out.begin(), out.end(), [](const Written& a, const Written& b) { return a.written_s < b.written_s; });
  return out;
}

/// What is made of a recording: errors of the stamps, and what was found.
struct Continued {
  std::vector<double> errors_s;
  std::vector<ClockSetBack> found;
  std::size_t most_waiting = 0;

  explicit Continued(const std::vector<Written>& records) {
    ContinuedTime<std::size_t> time;
    std::size_t next = 0, pushed = 0;
    const auto take = [&](bool complete) {
      while (const auto item = time.pop(complete)) {
        EXPECT_EQ(item->record, next++);
        errors_s.push_back(item->t + item->added_s - records[item->record].true_t);
      }
      most_waiting = std::max(most_waiting, pushed - next);
    };
    for (const Written& record : records) {
      time.push(record.sensor, record.t, pushed++);
      take(false);
    }
    take(true);
    EXPECT_EQ(next, records.size());
    found = time.found();
  }
};

constexpr double kJump = 10;  // s; true time

std::vector<Sensor> robot(double back_s) {
  return {{"wheels", 0.05, 0, back_s, kJump}, {"lidar", 0.1, 0.01, back_s, kJump}, {"camera", 1 / 3., 0.04, back_s, kJump}, {"", 1 / 3., 0.04, back_s, kJump}};
}

TEST(ContinuedTime, GoesOnWhereAllClocksAreSetBack) {
  for (const double back_s : {1.2, 2., 3600.}) {
    const Continued out(recordingOf(robot(back_s), 20));
    ASSERT_THAT(out.found, SizeIs(1)) << back_s;
    EXPECT_NEAR(out.found[0].seconds, back_s, 1e-9);
    EXPECT_NEAR(out.found[0].t, kJump - back_s, 1e-9);
    EXPECT_THAT(out.errors_s, Each(DoubleNear(0, 1e-9))) << back_s;
  }
}

TEST(ContinuedTime, GoesOnForOneSensorAloneAndTwice) {
  auto records = recordingOf({{"lidar", 0.1, 0, 5, kJump}}, 30);
  for (Written& record : records)
    if (record.true_t >= 20) record.t -= 7;
  const Continued out(records);
  EXPECT_THAT(out.found, SizeIs(2));
  EXPECT_THAT(out.errors_s, Each(DoubleNear(0, 1e-9)));
}

TEST(ContinuedTime, RecordsWaitOnlyAtTheJump) {
  EXPECT_EQ(Continued(recordingOf(robot(0), 20)).most_waiting, 0u);
  EXPECT_LT(Continued(recordingOf(robot(2), 20)).most_waiting, 90u);  // those of two seconds
}

TEST(ContinuedTime, OneOfSeveralClocksIsLeftAlone) {
  for (std::size_t i = 0; i < 3; ++i) {
    auto sensors = robot(0);
    sensors[i].back_s = 2;
    sensors[i].from_s = kJump;
    EXPECT_THAT(Continued(recordingOf(sensors, 20)).found, IsEmpty()) << i;
  }
}

// Images that were taken before, and are written after scans and wheels whose clock is set back.
TEST(ContinuedTime, WhatWasTakenBeforeAndIsWrittenLaterCostsItsRecordsOnly) {
  auto sensors = robot(2);
  sensors[2].interval_s = sensors[3].interval_s = 0.1;
  sensors[2].late_s = sensors[3].late_s = 0.25;
  const Continued out(recordingOf(sensors, 20));
  ASSERT_THAT(out.found, SizeIs(1));
  EXPECT_NEAR(out.found[0].seconds, 2, 1e-9);
  EXPECT_LT(std::count_if(out.errors_s.begin(), out.errors_s.end(), [](double error_s) { return std::abs(error_s) > 1e-9; }), 15);
}

TEST(ContinuedTime, SwappedRecordsSingleStampsAndPausesAreNoJump) {
  auto swapped = recordingOf({{"wheels", 0.2}, {"lidar", 1.5}, {"camera", 2}}, 60);
  for (const char* name : {"wheels", "lidar", "camera"}) {
    std::vector<Written*> own;
    for (Written& record : swapped)
      if (record.sensor == name) own.push_back(&record);
    for (std::size_t i = 1; i < own.size(); i += 2) std::swap(own[i - 1]->t, own[i]->t);
  }
  EXPECT_THAT(Continued(swapped).found, IsEmpty());
  auto single = recordingOf({{"lidar", 0.1}}, 20);
  single[50].t -= 3;
  EXPECT_THAT(Continued(single).found, IsEmpty());
  auto pause = recordingOf(robot(0), 20);
  for (Written& record : pause)
    if (record.true_t > 5) record.t += 30;
  EXPECT_THAT(Continued(pause).found, IsEmpty());
}

// Its driver began with another clock, or only its clock was wrong and is set right.
TEST(ContinuedTime, AClockThatWasAheadAloneIsLeftAlone) {
  auto first = recordingOf(robot(0), 20);
  std::find_if(first.begin(), first.end(), [](const Written& record) { return record.sensor == "camera"; })->t += 3;
  EXPECT_THAT(Continued(first).found, IsEmpty());
  auto ahead = recordingOf(robot(0), 20);
  for (Written& record : ahead)
    if (record.sensor == "camera" && record.true_t < kJump) record.t += 5;
  EXPECT_THAT(Continued(ahead).found, IsEmpty());
}

TEST(ContinuedTime, SensorsThatFallSilentKeepNobodyWaiting) {
  auto records = recordingOf(robot(20), 40);
  std::erase_if(records, [](const Written& record) { return record.sensor == "wheels" && record.true_t > kJump - 0.2; });
  const Continued out(records);
  ASSERT_THAT(out.found, SizeIs(1));
  EXPECT_NEAR(out.found[0].seconds, 20, 0.2);
  EXPECT_LT(out.most_waiting, 100u);
}

// Stamps that stand still behind the jump: nothing is known, and hardly anything waits.
TEST(ContinuedTime, FrozenStampsAreGivenUp) {
  auto records = recordingOf({{"lidar", 0.1}}, 200);
  for (Written& record : records)
    if (record.true_t > kJump) record.t = 3;
  const Continued out(records);
  EXPECT_THAT(out.found, IsEmpty());
  EXPECT_LE(out.most_waiting, 300u);
}

// As in logs that several processes wrote into one file, each with a buffer.
TEST(ContinuedTime, BlocksThatAreWrittenLateAreNoJump) {
  for (const std::size_t late : {3u, 6u, 16u, 30u}) {
    auto records = recordingOf({{"lidar", 0.1}, {"wheels", 0.1}}, 60);
    for (std::size_t begin = 20; begin + 3 * late < records.size(); begin += 60)
      std::rotate(records.begin() + static_cast<std::ptrdiff_t>(begin), records.begin() + static_cast<std::ptrdiff_t>(begin + late),
                  records.begin() + static_cast<std::ptrdiff_t>(begin + 3 * late));
    const Continued out(records);
    EXPECT_THAT(out.found, IsEmpty()) << late;
  }
}

// One stamp ahead of its time, and all those behind it seem to be late.
TEST(ContinuedTime, AStampThatWasAheadIsNoJump) {
  auto records = recordingOf({{"lidar", 0.1}}, 30);
  for (const std::size_t i : {50u, 51u, 52u, 150u}) records[i].t += 3;
  EXPECT_THAT(Continued(records).found, IsEmpty());
}

TEST(ContinuedTime, LittleIsLeftAlone) {
  EXPECT_THAT(Continued(recordingOf({{"camera", 1, 0, 0.5, kJump}}, 20)).found, IsEmpty());
  EXPECT_THAT(Continued(recordingOf(robot(0.8), 20)).found, IsEmpty()) << "as buffers of logs do";
}

}  // namespace
}  // namespace roomgraph
