// SPDX-License-Identifier: BSD-3-Clause
// ReplayControl: play, pause, step, speed and goal of a replay that runs in another thread.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>

namespace roomgraph {

/// What a person wants of a replay. The replay asks before every record whether it is its turn.
class ReplayControl {
 public:
  // By the person:
  void play(bool on);
  /// Seconds of the recording in a second; 0: as fast as the computer can.
  void setSpeed(double speed);
  /// Goes on, without pacing, until that many frames and scans are done.
  void runTo(int record);
  /// The replay is to end.
  void stop();

  // By the replay:
  /// Returns when the next record may be processed; false: the replay is to end. `t`: of the last record
  /// (nothing: there was none), `records`: frames and scans so far.
  bool waitForTurn(std::optional<double> t, int records);

 private:
  using Clock = std::chrono::steady_clock;
  std::optional<Clock::time_point> due(double t, Clock::time_point now);

  std::mutex mutex_;
  std::condition_variable changed_;
  bool playing_ = false, stopped_ = false;
  double speed_ = 1;
  int goal_ = 0;
  /// When which time of the recording was reached, since the pace was set.
  std::optional<std::pair<Clock::time_point, double>> start_;
};

}  // namespace roomgraph
