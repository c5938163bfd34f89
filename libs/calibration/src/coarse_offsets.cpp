// SPDX-License-Identifier: BSD-3-Clause
// Turn rates of lidar, wheels and camera, and the median of their offsets over the recordings.
#include "coarse_offsets.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/core/order_statistics.h"
#include "sensor_model.h"
#include "turn_rates.h"

namespace roomgraph {
namespace {

constexpr double kHalfWindow_s = 0.12;
constexpr double kLongestStep_s = 0.9;  // from one view of a board to the next

TurnRate ratesOf(const std::vector<PlanarPath>& paths) {
  return [&paths](double t) -> std::optional<double> {
    const PlanarPath* path = pathAt(paths, t, kHalfWindow_s);
    if (!path) return std::nullopt;
    return (path->at(t + kHalfWindow_s)[2] - path->at(t - kHalfWindow_s)[2]) / (2 * kHalfWindow_s);
  };
}

std::vector<CameraStep> stepsOf(const std::vector<BoardView>& views) {
  std::vector<CameraStep> out;
  for (std::size_t i = 1; i < views.size(); ++i)
    if (views[i].t - views[i - 1].t < kLongestStep_s)
      out.push_back({views[i - 1].t, views[i].t,
                     views[i - 1].camera_from_board * views[i].camera_from_board.inverse()});
  return out;
}

// About the robot's vertical axis; linear between the middles of steps.
TurnRate ratesOf(const std::vector<CameraStep>& steps, const ParameterVector& values) {
  std::vector<std::pair<double, double>> rates;
  const Eigen::Vector3d up = cameraRotation(values.data()).transpose().col(2);
  for (const auto& step : steps)
    rates.emplace_back((step.t_a + step.t_b) / 2,
                       logSO3(step.a_from_b.linear()).dot(up) / (step.t_b - step.t_a));
  return [rates](double t) -> std::optional<double> {
    constexpr double kGap_s = 1;
    const auto after = std::lower_bound(rates.begin(), rates.end(), std::make_pair(t, -1e9));
    if (after == rates.begin() || after == rates.end() || after->first - (after - 1)->first > kGap_s)
      return std::nullopt;
    const auto& [t_a, rate_a] = *(after - 1);
    return rate_a + (after->second - rate_a) * (t - t_a) / (after->first - t_a);
  };
}

}  // namespace

std::bitset<kParameterCount> addCoarseOffsets(const CalibrationTask& task, ParameterVector& values) {
  std::vector<double> camera, wheels;
  for (const auto& recording : task.evidence) {
    const auto& reference = recording.lidar;
    if (reference.empty()) continue;
    const double from = reference.front().time(0), to = reference.back().time(reference.back().size() - 1);
    // A board where visual odometry, which needs depth, does not say it.
    for (const auto& steps : {recording.steps, stepsOf(recording.boards)}) {
      const auto offset = turnRateOffset(ratesOf(reference), ratesOf(steps, values), from, to);
      if (!offset) continue;
      camera.push_back(*offset);
      break;
    }
    if (const auto offset = turnRateOffset(ratesOf(reference), ratesOf(recording.wheels), from, to))
      wheels.push_back(*offset);
  }
  std::bitset<kParameterCount> unknown;
  for (const auto& [offsets, parameter] : {std::pair(&camera, kCameraTime), std::pair(&wheels, kWheelTime)}) {
    if (task.held[static_cast<std::size_t>(parameter)]) continue;
    if (offsets->empty())
      unknown.set(static_cast<std::size_t>(parameter));
    else
      values[parameter] += median(*offsets);
  }
  return unknown;
}

}  // namespace roomgraph
