// SPDX-License-Identifier: BSD-3-Clause
// Who moves on, the stored states or the replay; ladder of speeds.
#include "roomgraph/viewer/playback.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

constexpr double kSlowest = 0.125, kFastest = 16;

}  // namespace

void Playback::setSpeed(double speed) {
  speed_ = speed;
  if (replay_) replay_->setSpeed(speed);
}

void Playback::faster() {
  if (speed_ > 0) setSpeed(speed_ >= kFastest ? 0 : std::exp2(std::floor(std::log2(speed_) + 1)));
}

void Playback::slower() {
  setSpeed(speed_ <= 0 ? kFastest : std::max(kSlowest, std::exp2(std::ceil(std::log2(speed_) - 1))));
}

// The replay runs only from where the stored states end.
void Playback::hand() {
  ahead_s_ = 0;
  if (replay_) replay_->play(playing_ && timeline_.atEnd());
}

void Playback::play(bool on) {
  if (on && !replay_ && timeline_.atEnd()) timeline_.seekRecord(0);  // once more
  playing_ = on;
  hand();
}

void Playback::step(bool forward) {
  playing_ = false;
  hand();
  if (forward && timeline_.atEnd()) {
    if (replay_) replay_->runTo(timeline_.empty() ? 1 : timeline_.newest().record + 1);
  } else {
    timeline_.move(forward ? 1 : -1);
  }
}

void Playback::seek(int record) {
  timeline_.seekRecord(record);
  hand();
  if (replay_ && timeline_.atEnd()) replay_->runTo(record);
}

void Playback::replayEnded() {
  if (replay_ && timeline_.atEnd()) playing_ = false;
  replay_ = nullptr;
}

void Playback::advance(double seconds) {
  if (!playing_ || timeline_.atEnd()) return;
  const double from = timeline_.shown().t;
  ahead_s_ += seconds * (speed_ > 0 ? speed_ : kFastest);
  timeline_.seekTime(from + ahead_s_);
  ahead_s_ -= timeline_.shown().t - from;
  if (!timeline_.atEnd()) return;
  playing_ = replay_ != nullptr;
  hand();
}

}  // namespace roomgraph
