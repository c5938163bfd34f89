// SPDX-License-Identifier: BSD-3-Clause
// When a run begins anew.
#include "run_beginnings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace roomgraph {
namespace {

constexpr int kMostBeginnings = 4;
constexpr double kLatest_s = 600;  // of the recording; what is found wrong later is reported
constexpr double kEvery_s = 1, kLasts_s = 5;
constexpr double kLeastAgain_s = 0.03;  // that is worth another beginning

// Those that had been read for certain, whatever a thread has read beyond.
StampJumpsBySensor until(double t, StampJumpsBySensor jumps) {
  for (auto& [label, all] : jumps) std::erase_if(all, [t](const StampJump& jump) { return jump.t > t; });
  return jumps;
}

}  // namespace

void RunBeginnings::again() {
  ++begun_;
  addClocks(found_clocks_, clocks_);
  addMounts(found_mounts_, mounts_);
  found_clocks_.clear();
  found_mounts_.clear();
  wrong_.clear();
  looked_s_ = -1e300;
}

bool RunBeginnings::shallBegin(const SemanticSlam& slam, const RawlogReader& reader, const ReplayState& now, const WhatStays& stays, bool ended) {
  if (begun_ >= kMostBeginnings || now.seconds() > kLatest_s || (!ended && now.seconds() < looked_s_ + kEvery_s)) return false;
  looked_s_ = now.seconds();
  const GeneralOptions& options = slam.setup().options.general;
  const FrontEnds& sensors = slam.frontEnds();
  const auto clocks = options.set_clocks ? wrongClocks(sensors) : std::vector<ClockSetting>{};
  const bool sets_poses = options.set_poses && !stays.poses && !sensors.shareLabel() && clocks.empty();
  found_mounts_ = sets_poses ? wrongMounts(sensors.agreement(), slam.cameraTilt(), sensors.labels()) : std::vector<MountSetting>{};
  std::vector<std::string> wrong;
  for (const ClockSetting& clock : clocks) wrong.push_back(std::string("clock of ") + toString(clock.sensor));
  for (const MountSetting& mount : found_mounts_) wrong.push_back(std::string("pose of ") + toString(mount.sensor));
  if (wrong != wrong_) {
    wrong_ = wrong;
    wrong_since_s_ = now.seconds();
  }
  if (wrong.empty() || (!ended && now.seconds() < wrong_since_s_ + kLasts_s)) return false;
  found_clocks_ = settable(clocks, sensors.clocks(), until(now.last_t, reader.stampJumps()));
  if (stays.stamps_of_images) found_clocks_ = withoutCamera(found_clocks_, sensors);
  const bool worth = std::any_of(found_clocks_.begin(), found_clocks_.end(), [&](const ClockSetting& clock) {
    return clocks_.empty() || std::abs(clock.offset.seconds) > kLeastAgain_s;
  });
  if (!worth) found_clocks_.clear();
  return worth || !found_mounts_.empty();
}

void RunBeginnings::correct(ReadOptions& reading, const WhatStays& stays) const {
  addClocks(clocks_, reading.corrections);
  addMounts(mounts_, reading.corrections);
  reading.continue_time = reading.continue_time && !stays.stamps_of_images;
}

std::vector<std::string> RunBeginnings::reasons(const ReplayState& replayed) const {
  std::vector<std::string> out;
  char seconds[96];
  std::snprintf(seconds, sizeof seconds, ", as the first %.0f s show; begun anew with", replayed.seconds());
  const auto add = [&](const Finding& finding, const char* corrected) { out.push_back(finding.place + ": " + finding.what + seconds + corrected); };
  for (const ClockSetting& clock : found_clocks_) add(clockFinding(clock, false), " stamps corrected");
  for (const MountSetting& mount : found_mounts_) add(mountFinding(mount, false), " its pose corrected");
  return out;
}

double RunBeginnings::longestOffset() const {
  double out = 0;
  for (const ClockSetting& clock : clocks_) out = std::max(out, std::abs(clock.offset.seconds));
  return out;
}

}  // namespace roomgraph
