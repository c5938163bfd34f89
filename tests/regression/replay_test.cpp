// SPDX-License-Identifier: BSD-3-Clause
// Replay of a span of a recording: counts, progress and interruption.
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/pipeline/replay.h"

#include <gtest/gtest.h>

#include "temporary_folder.h"
#include "tiny_recording.h"

namespace roomgraph::test {
namespace {

// 2.4 s of a lidar and wheels at 10 Hz.
class ReplayTest : public ::testing::Test {
 protected:
  void SetUp() override {
    test::writeRawlog(folder.file("tiny.rawlog"), TinyRecording(25).records({true, false, true}));
  }
  ReplayState replayed(
      const ReplaySpan& span, const std::function<bool()>& interrupted = [] { return false; }) {
    const auto config = Config::fromText("[tracking]\nenabled = false\n[detection]\nenabled = false\n");
    SemanticSlam slam(makeSetup(config, ROOMGRAPH_SOURCE_DIR "/objects.ini"));
    RawlogReader reader(folder.file("tiny.rawlog"));
    shares.clear();
    return replay(reader, slam, span,
                  {[&](const ReplayState& state) { shares.push_back(state.share); }, interrupted});
  }

  TemporaryFolder folder;
  std::vector<double> shares;
};

TEST_F(ReplayTest, WholeRecording) {
  const ReplayState state = replayed({});
  EXPECT_EQ(state.records, 50);
  EXPECT_NEAR(state.seconds(), 2.4, 1e-6);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_NEAR(shares.back(), 1, 1e-9);
  EXPECT_FALSE(state.interrupted);
}

TEST_F(ReplayTest, ProgressIsThatOfTheSpan) {
  const ReplayState state = replayed({.from_s = 0.95, .until_s = 2.05});
  EXPECT_EQ(state.records, 22);  // 1.0 to 2.0 s
  EXPECT_NEAR(state.seconds(), 1.0, 1e-6);
  EXPECT_NEAR(state.first_t - state.start_t, 1.0, 1e-6);
  EXPECT_LT(shares.front(), 0.01);
  EXPECT_GT(shares.back(), 0.9);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
}

TEST_F(ReplayTest, SpanPastTheEndTellsWhereThatIs) {
  const ReplayState state = replayed({.from_s = 100});
  EXPECT_EQ(state.records, 0);
  EXPECT_NEAR(state.last_t - state.start_t, 2.4, 1e-6);
}

TEST_F(ReplayTest, InterruptedBetweenTwoRecords) {
  int asked = 0;
  const ReplayState state = replayed({}, [&] { return ++asked > 10; });
  EXPECT_TRUE(state.interrupted);
  EXPECT_EQ(state.records, 10);
}

}  // namespace
}  // namespace roomgraph::test
