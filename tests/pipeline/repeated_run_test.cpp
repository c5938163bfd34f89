// SPDX-License-Identifier: BSD-3-Clause
// A run that is repeated with a part of its results: the same bits, and only the rest is computed.
#include <gtest/gtest.h>

#include <cstring>

#include "drive.h"
#include "results_in_memory.h"

namespace roomgraph::test {
namespace {

/// All numbers that a run ends with, live poses first.
std::vector<double> outcomeOf(ResultStore* results) {
  struct Live : Sink {
    std::vector<double> numbers;
    void onStep(const StepReport& report) override {
      for (const double value : report.world_from_robot.matrix().reshaped()) numbers.push_back(value);
    }
  };
  SemanticSlam slam(
      setupWith("[tracking]\nenabled = false\n[detection]\nenabled = false\n"
                "[backend]\noptimize_every_nodes = 6\n"));
  if (results) slam.setResultStore(*results);
  const auto live = std::make_shared<Live>();
  slam.addSink(live);
  Drive world;
  for (int i = 0; 0.1 * i <= Drive::kLap_s; ++i) {
    slam.process(world.odometry(0.1 * i));
    slam.process(world.scan(0.1 * i));
  }
  const SlamResult result = slam.finish();
  std::vector<double> out = live->numbers;
  for (const auto& stamped : result.world_from_robot)
    for (const double value : stamped.pose.matrix().reshaped()) out.push_back(value);
  const auto graph = slam.graph().values();
  out.insert(out.end(), graph.begin(), graph.end());
  return out;
}

TEST(RepeatedRun, WithAnyBeginningOfItsResultsGivesTheSameBits) {
  const auto undisturbed = outcomeOf(nullptr);
  ResultsInMemory first;
  EXPECT_EQ(outcomeOf(&first), undisturbed) << "to keep results changes nothing";
  ASSERT_GE(first.kept, 8u) << "whole graph, live and with hindsight";
  for (std::size_t count = 0; count <= first.kept; count += 3) {
    ResultsInMemory again = first.beginning(count);
    EXPECT_EQ(outcomeOf(&again), undisturbed) << "with " << count << " results";
    EXPECT_EQ(again.next, count);
    EXPECT_EQ(again.kept, first.kept - count) << "only the rest was computed";
  }
}

// If it did not, the test above would compare computations only.
TEST(RepeatedRun, TakesOverWhatIsRecalled) {
  ResultsInMemory first;
  const auto undisturbed = outcomeOf(&first);
  ResultsInMemory changed = first.beginning(3);
  std::string& bytes = changed.all[2].bytes;  // a pose of the graph, 1 mm off
  double x = 0;
  std::memcpy(&x, bytes.data() + 7 * sizeof x, sizeof x);
  x += 0.001;
  std::memcpy(bytes.data() + 7 * sizeof x, &x, sizeof x);
  EXPECT_NE(outcomeOf(&changed), undisturbed);
}

}  // namespace
}  // namespace roomgraph::test
