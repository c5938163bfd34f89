// SPDX-License-Identifier: BSD-3-Clause
// Playback: play, step and seek over what is stored and, beyond its end, over a replay that goes on.
#pragma once

#include "roomgraph/viewer/replay_control.h"
#include "roomgraph/viewer/timeline.h"

namespace roomgraph {

/// The controls of a player. Back in time it shows what was stored then; forward from the end of that it lets
/// the replay run.
class Playback {
 public:
  /// `replay` null: everything is stored already. Both outlive the playback.
  Playback(Timeline& timeline, ReplayControl* replay) : timeline_(timeline), replay_(replay) {}

  bool playing() const { return playing_; }
  /// Seconds of the recording in a second; 0: as fast as possible.
  double speed() const { return speed_; }
  void setSpeed(double speed);
  /// To the next of 1/8, 1/4 … 16, and as fast as possible.
  void faster();
  void slower();

  void play(bool on);
  /// Pauses, and goes one state on or back (`forward` false).
  void step(bool forward);
  /// Shows that record: as it was stored, or when the replay comes to it.
  void seek(int record);
  /// Once per picture, with the seconds since the last one: moves on through what is stored.
  void advance(double seconds);
  /// The replay has come to its end: everything is stored.
  void replayEnded();

 private:
  void hand();

  Timeline& timeline_;
  ReplayControl* replay_;
  bool playing_ = false;
  double speed_ = 1;
  double ahead_s_ = 0;  ///< of the recording, played since the state that is shown
};

}  // namespace roomgraph
