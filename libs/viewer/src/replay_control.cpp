// SPDX-License-Identifier: BSD-3-Clause
// Waiting for the turn of a record: goal, pause and pace.
#include "roomgraph/viewer/replay_control.h"

#include <algorithm>

namespace roomgraph {
namespace {

/// A replay that is later than this does not catch up: the computer is too slow for the speed.
constexpr std::chrono::milliseconds kLatest{200};
/// A gap in the recording is not waited for longer than this.
constexpr double kLongestWait_s = 2;

}  // namespace

void ReplayControl::play(bool on) {
  const std::lock_guard lock(mutex_);
  playing_ = on;
  start_.reset();
  changed_.notify_all();
}

void ReplayControl::setSpeed(double speed) {
  const std::lock_guard lock(mutex_);
  speed_ = speed;
  start_.reset();
  changed_.notify_all();
}

void ReplayControl::runTo(int record) {
  const std::lock_guard lock(mutex_);
  goal_ = record;
  changed_.notify_all();
}

void ReplayControl::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

// When the record after the one of time t may come; nothing: now.
std::optional<ReplayControl::Clock::time_point> ReplayControl::due(double t, Clock::time_point now) {
  if (speed_ <= 0) return std::nullopt;
  if (!start_) start_ = {now, t};
  const auto& [since, from_t] = *start_;
  const auto at = since + std::chrono::duration_cast<Clock::duration>(
                              std::chrono::duration<double>((t - from_t) / speed_));
  if (at > now && at - now < std::chrono::duration<double>(kLongestWait_s)) return at;
  if (now - at > kLatest || at > now) start_ = {now, t};
  return std::nullopt;
}

bool ReplayControl::waitForTurn(std::optional<double> t, int records) {
  std::unique_lock lock(mutex_);
  while (true) {
    if (stopped_) return false;
    if (records < goal_) {
      start_.reset();
      return true;
    }
    if (!playing_) {
      changed_.wait(lock);
    } else if (const auto at = t ? due(*t, Clock::now()) : std::nullopt) {
      changed_.wait_until(lock, *at);
    } else {
      return true;
    }
  }
}

}  // namespace roomgraph
