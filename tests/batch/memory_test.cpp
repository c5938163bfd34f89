// SPDX-License-Identifier: BSD-3-Clause
// Forecasts of memory from earlier runs.
#include "memory.h"

#include <gtest/gtest.h>

#include <cmath>

#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

TEST(MemoryForecasts, AreTheSameRecordingsPeakWithAMargin) {
  MemoryForecast forecast({{"a", 1000, 400, 1}, {"b", 2000, 900, 1}});
  EXPECT_DOUBLE_EQ(forecast.expected("a", 1000), 500);
  EXPECT_DOUBLE_EQ(forecast.expected("b", 2000), 1125);
  forecast.add({"a", 1000, 800, 1});
  EXPECT_DOUBLE_EQ(forecast.expected("a", 1000), 1000);
  forecast.add({"a", 1000, 100, 1});
  EXPECT_DOUBLE_EQ(forecast.expected("a", 1000), 1000) << "the largest counts";
}

TEST(MemoryForecasts, ElseTheNearestSizeScaledUp) {
  const MemoryForecast forecast({{"a", 1000, 400, 1}, {"b", 100000, 900, 1}});
  EXPECT_DOUBLE_EQ(forecast.expected("c", 1500), 1.25 * 400 * 1.5);
  EXPECT_DOUBLE_EQ(forecast.expected("c", 80000), 1.25 * 900) << "never scaled down";
  EXPECT_DOUBLE_EQ(forecast.expected("c", 200000), 1.25 * 1800);
}

TEST(MemoryForecasts, ElseAGuessThatGrowsWithTheRecording) {
  const MemoryForecast forecast({});
  EXPECT_GT(forecast.expected("c", 0), 100);
  EXPECT_GT(forecast.expected("c", 4000000000), 1000);
}

TEST(AvailableMemory, IsThatOfAMachine) {
  EXPECT_GT(availableMemory(), 10);
  EXPECT_LT(availableMemory(), 1e9);
}

TEST(AvailableMemory, WhatAContainerHoldsOfFilesIsRoom) {
  const TemporaryFolder group;
  EXPECT_TRUE(std::isinf(controlGroupRoom(group.path())));
  group.write("memory.max", "max\n");
  group.write("memory.current", "7000000000\n");
  EXPECT_TRUE(std::isinf(controlGroupRoom(group.path())));
  group.write("memory.max", "8000000000\n");
  EXPECT_DOUBLE_EQ(controlGroupRoom(group.path()), 1000);
  group.write("memory.stat", "anon 2000000000\nfile 5000000000\nkernel 1000\ninactive_file 3000000000\nactive_file 1500000000\n");
  EXPECT_DOUBLE_EQ(controlGroupRoom(group.path()), 5500);
}

}  // namespace
}  // namespace roomgraph::test
