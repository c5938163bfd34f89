// SPDX-License-Identifier: BSD-3-Clause
// A run that is repeated with a part of its results: the same bits, and only the rest is computed.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "drive.h"
#include "roomgraph/core/result_store.h"

namespace roomgraph::test {
namespace {

/// Results in memory, of which the first so many are recalled.
class Results : public ResultStore {
 public:
  struct Result {
    std::string name;
    double t;
    std::string bytes;
  };
  std::optional<std::string> recall(std::string_view name, double t) override {
    if (next == recallable) return std::nullopt;
    const Result& result = all[next++];
    EXPECT_EQ(result.name, name);
    EXPECT_EQ(result.t, t);
    return result.bytes;
  }
  void keep(std::string_view name, double t, std::string_view bytes) override {
    all.push_back({std::string(name), t, std::string(bytes)});
    ++kept;
  }
  /// For a repetition that has the first `count` of them.
  Results beginning(std::size_t count) const {
    Results out;
    out.all.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
    out.recallable = count;
    return out;
  }

  std::vector<Result> all;
  std::size_t next = 0, recallable = 0, kept = 0;
};

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
                "[backend]\noptimize_every_nodes = 10\n"));
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
  Results first;
  EXPECT_EQ(outcomeOf(&first), undisturbed) << "to keep results changes nothing";
  ASSERT_GE(first.kept, 8u) << "whole graph, live and with hindsight";
  for (std::size_t count = 0; count <= first.kept; ++count) {
    Results again = first.beginning(count);
    EXPECT_EQ(outcomeOf(&again), undisturbed) << "with " << count << " results";
    EXPECT_EQ(again.next, count);
    EXPECT_EQ(again.kept, first.kept - count) << "only the rest was computed";
  }
}

// If it did not, the test above would compare computations only.
TEST(RepeatedRun, TakesOverWhatIsRecalled) {
  Results first;
  const auto undisturbed = outcomeOf(&first);
  Results changed = first.beginning(3);
  std::string& bytes = changed.all[2].bytes;  // a pose of the graph, 1 mm off
  double x = 0;
  std::memcpy(&x, bytes.data() + 7 * sizeof x, sizeof x);
  x += 0.001;
  std::memcpy(bytes.data() + 7 * sizeof x, &x, sizeof x);
  EXPECT_NE(outcomeOf(&changed), undisturbed);
}

}  // namespace
}  // namespace roomgraph::test
