// SPDX-License-Identifier: BSD-3-Clause
// When a run begins anew.
#include "run_beginnings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace roomgraph {
namespace {

constexpr int kMostBeginnings = 3;
constexpr double kLatest_s = 600;  // of the recording; clocks that are found wrong later are reported
constexpr double kLasts_s = 5;
constexpr double kLeastAgain_s = 0.03;  // that is worth another beginning

// Those that had been read for certain, whatever a thread has read beyond.
StampJumpsBySensor until(double t, StampJumpsBySensor jumps) {
  for (auto& [label, all] : jumps) std::erase_if(all, [t](const StampJump& jump) { return jump.t > t; });
  return jumps;
}

}  // namespace

void RunBeginnings::again() {
  ++begun_;
  addClocks(found_, clocks_);
  found_.clear();
  wrong_.clear();
}

bool RunBeginnings::shallBegin(const SemanticSlam& slam, const RawlogReader& reader, const ReplayState& now, bool images_stay, bool ended) {
  if (!slam.setup().options.general.set_clocks || begun_ >= kMostBeginnings || now.seconds() > kLatest_s) return false;
  const FrontEnds& sensors = slam.frontEnds();
  const auto wrong = wrongClocks(sensors);
  std::vector<MotionSensor> who;
  for (const ClockSetting& clock : wrong) who.push_back(clock.sensor);
  if (who != wrong_) {
    wrong_ = who;
    wrong_since_s_ = now.seconds();
  }
  if (wrong.empty() || (!ended && now.seconds() < wrong_since_s_ + kLasts_s)) return false;
  found_ = settable(wrong, sensors.clocks(), until(now.last_t, reader.stampJumps()));
  if (images_stay) found_ = withoutCamera(found_, sensors);
  return std::any_of(found_.begin(), found_.end(),
                     [&](const ClockSetting& clock) { return begun_ == 1 || std::abs(clock.offset.seconds) > kLeastAgain_s; });
}

std::vector<std::string> RunBeginnings::reasons(const ReplayState& replayed) const {
  std::vector<std::string> out;
  for (const ClockSetting& clock : found_) {
    char seconds[96];
    std::snprintf(seconds, sizeof seconds, ", as the first %.0f s show; begun anew with stamps corrected", replayed.seconds());
    const Finding finding = clockFinding(clock, false);
    out.push_back(finding.place + ": " + finding.what + seconds);
  }
  return out;
}

double RunBeginnings::longestOffset() const {
  double out = 0;
  for (const ClockSetting& clock : clocks_) out = std::max(out, std::abs(clock.offset.seconds));
  return out;
}

}  // namespace roomgraph
