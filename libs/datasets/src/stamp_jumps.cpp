// SPDX-License-Identifier: BSD-3-Clause
// Jumps of the lead of stamps over the latest ones of other sensors.
#include "stamp_jumps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roomgraph {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLeastJump_s = 0.15;
constexpr double kAlike = 0.3, kAlikeLead = 0.5;  // shares of a jump; leads differ by the others' intervals as well

bool isAbout(double found_s, double expected_s, double share) { return std::abs(found_s - expected_s) < share * std::abs(expected_s); }

}  // namespace

bool StampJumps::jumped(const std::string& sensor) const {
  const auto known = sensors_.find(sensor);
  return known != sensors_.end() && known->second.jumped;
}

// A gap changes intervals, a slow sensor the lead of the others; a jump changes both.
bool StampJumps::add(const std::string& sensor, double t, double expected_s) {
  double latest = -kInfinity;
  for (const auto& [name, stamps] : sensors_)
    if (name != sensor) latest = std::max(latest, stamps.t);
  const auto known = sensors_.find(sensor);
  if (known == sensors_.end()) {
    sensors_[sensor] = {.t = t, .lead_s = t - latest};
    return false;
  }
  Stamps& own = known->second;
  const double interval_s = t - own.t, lead_s = t - latest;
  const double jump_s = interval_s - own.interval_s;
  if (std::abs(jump_s) > kLeastJump_s && isAbout(lead_s - own.lead_s, jump_s, kAlikeLead)) {
    found_[sensor].push_back({t, jump_s});
    if (isAbout(jump_s, own.jumped ? -expected_s : expected_s, kAlike)) own.jumped = !own.jumped;
  } else {
    own.interval_s = interval_s;
  }
  own.t = t;
  own.lead_s = lead_s;
  return own.jumped;
}

}  // namespace roomgraph
