// SPDX-License-Identifier: BSD-3-Clause
// Playback over stored states, and the turns of a replay in another thread: pause, steps, goals, pace, end.
#include "roomgraph/viewer/playback.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "made_up_states.h"

namespace roomgraph::test {
namespace {

using std::chrono::milliseconds;

/// A replay of records of 0.1 s in a thread, that does nothing but count.
class Counting {
 public:
  explicit Counting(ReplayControl& control) : control_(control), thread_([this] { work(); }) {}
  ~Counting() {
    control_.stop();
    thread_.join();
  }
  int records() const { return records_; }
  /// Waits until there are so many, and then a little for more.
  int settled(int wanted) const {
    for (int i = 0; i < 400 && records_ < wanted; ++i) std::this_thread::sleep_for(milliseconds(5));
    std::this_thread::sleep_for(milliseconds(30));
    return records_;
  }

 private:
  void work() {
    std::optional<double> t;
    while (control_.waitForTurn(t, records_)) t = kBegin_t + 0.1 * ++records_;
  }
  ReplayControl& control_;
  std::atomic<int> records_{0};
  std::thread thread_;
};

TEST(ReplayControl, NothingRunsUntilSomebodyPlays) {
  ReplayControl control;
  control.setSpeed(0);
  Counting replay(control);
  EXPECT_EQ(replay.settled(0), 0);
  control.play(true);
  EXPECT_GT(replay.settled(50), 50);
  control.play(false);
  const int before = replay.settled(0);
  EXPECT_EQ(replay.settled(0), before) << "paused";
}

TEST(ReplayControl, RunsToAGoalWhilePaused) {
  ReplayControl control;
  Counting replay(control);
  control.runTo(3);
  EXPECT_EQ(replay.settled(3), 3);
  control.runTo(2);
  EXPECT_EQ(replay.settled(3), 3) << "a goal in the past";
  control.runTo(40);
  EXPECT_EQ(replay.settled(40), 40);
}

TEST(ReplayControl, KeepsThePaceOfTheRecording) {
  ReplayControl control;
  control.setSpeed(4);
  const auto start = std::chrono::steady_clock::now();
  Counting replay(control);
  control.play(true);
  replay.settled(16);  // 1.5 s of the recording after the first record
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  EXPECT_GT(spent.count(), 0.3);
  EXPECT_LT(spent.count(), 1.5);
}

TEST(ReplayControl, DoesNotWaitThroughAGap) {
  ReplayControl control;
  control.setSpeed(1);
  control.play(true);
  EXPECT_TRUE(control.waitForTurn(std::nullopt, 0));
  EXPECT_TRUE(control.waitForTurn(100.0, 1));
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(control.waitForTurn(4000.0, 2)) << "an hour without records";
  EXPECT_TRUE(control.waitForTurn(100.0, 3)) << "a clock that was set back";
  EXPECT_LT(std::chrono::steady_clock::now() - start, milliseconds(500));
}

TEST(ReplayControl, EndsWhoeverWaits) {
  ReplayControl control;
  std::atomic<bool> went_on{true};
  std::thread waiting([&] { went_on = control.waitForTurn(std::nullopt, 0); });
  control.stop();
  waiting.join();
  EXPECT_FALSE(went_on);
  control.play(true);
  EXPECT_FALSE(control.waitForTurn(1.0, 1)) << "for good";
}

TEST(Playback, PlaysStoredStatesAtTheirPace) {
  Timeline timeline;
  timeline.add(statesFromTo(1, 10));
  Playback playback(timeline, nullptr);
  EXPECT_FALSE(playback.playing());
  playback.play(true);
  EXPECT_EQ(timeline.shown().record, 1) << "from the end: once more from the beginning";
  playback.advance(0.6);
  EXPECT_EQ(timeline.shown().record, 1);
  playback.advance(0.6);
  EXPECT_EQ(timeline.shown().record, 2) << "1.2 s after record 1";
  playback.advance(0.6);
  EXPECT_EQ(timeline.shown().record, 2);
  playback.advance(0.3);
  EXPECT_EQ(timeline.shown().record, 3) << "2.1 s: what was left over counts";
  playback.setSpeed(4);
  playback.advance(1);
  EXPECT_EQ(timeline.shown().record, 7);
  playback.play(false);
  playback.advance(5);
  EXPECT_EQ(timeline.shown().record, 7);
  playback.play(true);
  playback.advance(50);
  EXPECT_EQ(timeline.shown().record, 10);
  EXPECT_FALSE(playback.playing()) << "the end";
}

TEST(Playback, StepsAndSeeksInWhatIsStored) {
  Timeline timeline;
  timeline.add(statesFromTo(1, 10));
  Playback playback(timeline, nullptr);
  playback.step(false);
  EXPECT_EQ(timeline.shown().record, 9);
  playback.play(true);
  playback.step(false);
  EXPECT_EQ(timeline.shown().record, 8);
  EXPECT_FALSE(playback.playing()) << "a step pauses";
  playback.step(true);
  EXPECT_EQ(timeline.shown().record, 9);
  playback.step(true);
  playback.step(true);
  EXPECT_EQ(timeline.shown().record, 10) << "there is no more";
  playback.seek(4);
  EXPECT_EQ(timeline.shown().record, 4);
}

TEST(Playback, SpeedsAreALadderFromAnEighthToTheMaximum) {
  Timeline timeline;
  Playback playback(timeline, nullptr);
  std::vector<double> up, down;
  for (int i = 0; i < 6; ++i) playback.faster(), up.push_back(playback.speed());
  EXPECT_EQ(up, (std::vector<double>{2, 4, 8, 16, 0, 0}));
  for (int i = 0; i < 9; ++i) playback.slower(), down.push_back(playback.speed());
  EXPECT_EQ(down, (std::vector<double>{16, 8, 4, 2, 1, 0.5, 0.25, 0.125, 0.125}));
  playback.setSpeed(3);
  playback.faster();
  EXPECT_EQ(playback.speed(), 4);
  playback.setSpeed(3);
  playback.slower();
  EXPECT_EQ(playback.speed(), 2);
}

TEST(Playback, TheReplayRunsOnlyFromTheEndOfWhatIsStored) {
  Timeline timeline;
  ReplayControl control;
  control.setSpeed(0);
  Counting replay(control);
  Playback playback(timeline, &control);
  playback.step(true);
  EXPECT_EQ(replay.settled(1), 1) << "a step when nothing is there yet";
  timeline.add(statesFromTo(1, 1));
  playback.step(true);
  EXPECT_EQ(replay.settled(2), 2);
  timeline.add(statesFromTo(2, 2));
  playback.step(false);
  EXPECT_EQ(timeline.shown().record, 1);
  EXPECT_EQ(replay.settled(0), 2) << "back is what was stored";
  playback.play(true);
  EXPECT_EQ(replay.settled(0), 2) << "and so is forward, up to its end";
  playback.seek(6);
  EXPECT_EQ(timeline.shown().record, 2);
  EXPECT_GE(replay.settled(6), 6) << "a record that is still to come";
}

TEST(Playback, AtTheEndOfWhatIsStoredTheReplayGoesOn) {
  Timeline timeline;
  ReplayControl control;
  Counting replay(control);
  Playback playback(timeline, &control);
  playback.setSpeed(0);
  timeline.add(statesFromTo(1, 3));
  playback.seek(1);
  playback.play(true);
  EXPECT_EQ(replay.settled(0), 0);
  playback.advance(1);
  EXPECT_TRUE(timeline.atEnd()) << "as fast as possible";
  EXPECT_TRUE(playback.playing());
  EXPECT_GT(replay.settled(5), 5);
}

TEST(Playback, AfterTheReplayEverythingIsStored) {
  Timeline timeline;
  ReplayControl control;
  Playback playback(timeline, &control);
  timeline.add(statesFromTo(1, 4));
  playback.play(true);
  playback.replayEnded();
  EXPECT_FALSE(playback.playing());
  playback.play(true);
  EXPECT_EQ(timeline.shown().record, 1);
  playback.replayEnded();
  EXPECT_TRUE(playback.playing()) << "somebody looks at it again";
}

}  // namespace
}  // namespace roomgraph::test
