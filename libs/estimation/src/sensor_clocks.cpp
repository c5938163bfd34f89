// SPDX-License-Identifier: BSD-3-Clause
// Pairs of clocks, and the one that most agree with.
#include "roomgraph/estimation/sensor_clocks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roomgraph {
namespace {

constexpr double kKnown_s = 0.015, kSure_s = 0.006;  // standard deviations from which on an offset says who differs, and by how much
constexpr double kShareOfOffset = 0.125;                       // of an offset, that will do as well
constexpr double kAway_s = 5;                          // without a pose
constexpr double kLeastWrong_s = 0.015, kWrongSigmas = 6;
constexpr std::size_t kLidar = 0, kCamera = 1, kWheels = 2;

bool isKnown(const TimeOffset& offset, double sigma_s) { return offset.sigma < std::max(sigma_s, kShareOfOffset * std::abs(offset.seconds)); }

bool isSure(const TimeOffset& offset) { return isKnown(offset, kSure_s); }

bool isWrong(const TimeOffset& offset) {
  return std::abs(offset.seconds) > std::max(kLeastWrong_s, kWrongSigmas * offset.sigma);
}

TimeOffsets against(const TimeOffsets& offsets, std::size_t right) {
  TimeOffsets out = offsets;
  for (TimeOffset& offset : out)
    offset = {offset.seconds - offsets[right].seconds, std::hypot(offset.sigma, offsets[right].sigma)};
  out[right] = {};
  return out;
}

}  // namespace

void SensorClocks::compare(const Trajectory& lidar, const Trajectory& camera, const Trajectory& wheels, double predicted_t) {
  const std::array paths = {&lidar, &camera, &wheels};
  double latest = -std::numeric_limits<double>::infinity();
  for (const Trajectory* path : paths)
    if (!path->empty()) latest = std::max(latest, path->lastTime());
  for (std::size_t i = 0; i < paths.size(); ++i) there_[i] = !paths[i]->empty() && paths[i]->lastTime() > latest - kAway_s;
  const bool camera_jumped = camera_lidar_.compare(camera, lidar, predicted_t);
  if (camera_jumped) wheels_lidar_.forget();
  const bool wheels_jumped = wheels_lidar_.compare(wheels, lidar);
  if (wheels_jumped) camera_lidar_.forget();
  const bool jumped = camera_wheels_.compare(camera, wheels, predicted_t);
  jumped_ = jumped_ || camera_jumped || wheels_jumped || jumped;
  const auto all = offsets();
  if (!all) return;
  for (std::size_t i = 0; i < all->size(); ++i) agreed_[i] = agreed_[i] || (there_[i] && isSure((*all)[i]) && !isWrong((*all)[i]));
}

// Against the lidar, or against the wheels where there is none.
std::optional<TimeOffsets> SensorClocks::againstFirst() const {
  TimeOffsets out;
  const auto set = [&](std::size_t sensor, const ClockComparison& comparison) {
    const auto offset = comparison.offset();
    if (offset) out[sensor] = *offset;
    return offset && isKnown(*offset, kKnown_s);
  };
  if (there_[kCamera] && !set(kCamera, there_[kLidar] ? camera_lidar_ : camera_wheels_)) return std::nullopt;
  if (there_[kWheels] && there_[kLidar] && !set(kWheels, wheels_lidar_)) return std::nullopt;
  return out;
}

std::optional<TimeOffsets> SensorClocks::offsets() const {
  if (std::count(there_.begin(), there_.end(), true) < 2) return std::nullopt;
  const auto known = againstFirst();
  if (!known) return std::nullopt;
  const bool camera_known_better = (*known)[kCamera].sigma < (*known)[kWheels].sigma;
  std::optional<TimeOffsets> best;
  std::ptrdiff_t most = 0;
  for (const std::size_t right : {kLidar, camera_known_better ? kCamera : kWheels, camera_known_better ? kWheels : kCamera}) {
    if (!there_[right]) continue;
    const TimeOffsets offsets = against(*known, right);
    std::ptrdiff_t agree = 0;
    for (std::size_t i = 0; i < offsets.size(); ++i) agree += there_[i] && !isWrong(offsets[i]);
    if (agree <= most) continue;
    most = agree;
    best = offsets;
  }
  return best;
}

std::optional<TimeOffsets> SensorClocks::wrong() const {
  auto found = offsets();
  if (!found || std::none_of(found->begin(), found->end(), isWrong)) return std::nullopt;
  for (TimeOffset& offset : *found) {
    if (!isWrong(offset)) offset = {};
    if (!isSure(offset)) return std::nullopt;
  }
  return found;
}

}  // namespace roomgraph
