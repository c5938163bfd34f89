// SPDX-License-Identifier: BSD-3-Clause
// Durations by stage, the waiting line against hand-made arrivals and queueing theory, and the report.
#include "roomgraph/pipeline/speed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;

TEST(Speed, FiguresOfDurations) {
  std::vector<double> all;
  for (int i = 1; i <= 101; ++i) all.push_back(i);
  const auto f = figuresOf(all);
  EXPECT_EQ(f.count, 101);
  EXPECT_DOUBLE_EQ(f.mean_ms, 51);
  EXPECT_EQ(f.median_ms, 51);
  EXPECT_EQ(f.p99_ms, 100);
  EXPECT_EQ(f.max_ms, 101);
  EXPECT_EQ(figuresOf({}).count, 0);
}

TEST(Speed, WhatIsBusyLetsWait) {
  WaitingLine line;
  EXPECT_DOUBLE_EQ(line.serve(10, 2), 2);
  EXPECT_DOUBLE_EQ(line.serve(11, 2), 3) << "one second until the first is done";
  EXPECT_DOUBLE_EQ(line.serve(20, 0.5), 0.5) << "nobody is before it";
  EXPECT_DOUBLE_EQ(line.serve(20, 0.5), 1);
}

// M/M/1: with arrivals at rate a and work at rate w the mean time in the system is 1 / (w - a).
TEST(Speed, MeanLatencyIsThatOfQueueingTheory) {
  std::mt19937 random(3);
  std::exponential_distribution<double> between(1), work(2);
  WaitingLine line;
  double t = 0, sum = 0;
  constexpr int kRecords = 400000;
  for (int i = 0; i < kRecords; ++i) sum += line.serve(t += between(random), work(random));
  EXPECT_NEAR(sum / kRecords, 1, 0.03);
}

TEST(Speed, StagesAreSummedAndSorted) {
  StageTimes times;
  times.add("short", {1, 0.5});
  times.add("long", {10, 4});
  times.add("short", {3, 0.5});
  const auto stages = speedOfStages(times);
  ASSERT_EQ(stages.size(), 2u);
  EXPECT_EQ(stages[0].stage, "long");
  EXPECT_EQ(stages[1].call.count, 2);
  EXPECT_EQ(stages[1].total_ms, 4);
  EXPECT_EQ(stages[1].cpu_ms, 1);
}

TEST(Speed, SinkKeepsSensorsApart) {
  LatencySink sink;
  for (int i = 0; i < 3; ++i) sink.onStep({.kind = StepReport::Kind::kFrame, .t = 1.0 + i});
  sink.onStep({.kind = StepReport::Kind::kScan, .t = 4.5});
  sink.onStep({.kind = StepReport::Kind::kOther, .t = 4.6});
  EXPECT_EQ(sink.frames().count, 3);
  EXPECT_EQ(sink.scans().count, 1);
  EXPECT_GE(sink.frames().max_ms, 0);
  EXPECT_LT(sink.frames().max_ms, 500);
}

TEST(Speed, ReportAsTableAndAsJson) {
  SpeedReport report;
  report.recorded_s = 120;
  report.wall_s = 60;
  report.cpu_s = 90;
  report.end_s = 3;
  report.threads = 2;
  report.stages = {{"matching", {10, 1.5, 1.2, 4, 5}, 15000, 12000}};
  report.frames = {10, 20, 18, 40, 50};
  const std::string table = toTable(report);
  EXPECT_THAT(table, HasSubstr("2.00 x real time; 1.50 of 2 cores"));
  EXPECT_THAT(table, HasSubstr("1.50 s for each minute recorded"));
  EXPECT_THAT(table, HasSubstr("matching"));
  EXPECT_THAT(table, ::testing::Not(HasSubstr("scans")));
  const auto json = nlohmann::json::parse(toJson(report));
  EXPECT_EQ(json["times_real_time"], 2);
  EXPECT_EQ(json["stages"][0]["p99_ms"], 4);
  EXPECT_EQ(json["latency"]["frames"]["median_ms"], 18);
}

}  // namespace
}  // namespace roomgraph::test
