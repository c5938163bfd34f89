// SPDX-License-Identifier: BSD-3-Clause
// Closeness criterion over sampled yaw, and its local maxima.
#include "rectangle_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "roomgraph/core/order_statistics.h"
#include "vertical_faces.h"

namespace roomgraph {
namespace {

constexpr int kSteps = 45;  // of 2 degrees over [0, 90)
constexpr int kPeakReach = 4;                  // steps to each side within which a maximum is the largest
constexpr double kLow = 0.02, kHigh = 0.98;    // quantiles taken for the ends of noisy points
constexpr double kLeastDistance_m = 0.03;      // nearer points are all equally near: the depth noise
constexpr double kLeastSide_m = 0.05;          // a thinner rectangle is no better
constexpr std::size_t kLeastFootprint = 5;     // points
constexpr double kWithoutFaces = 0.2;          // of the criterion, where no face has the direction

struct Extent {
  double low = 0, high = 0;
  double size() const { return high - low; }
};

Extent extentAlong(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& axis,
                   std::vector<double>& values) {
  values.clear();
  for (const auto& p : points) values.push_back(axis.dot(p));
  return {quantile(values, kLow), quantile(values, kHigh)};
}

// The end of an axis with more points near it is the visible side; replaces the values by distances from it.
void distancesToSide(std::vector<double>& values, const Extent& extent) {
  double to_low = 0, to_high = 0;
  for (const double x : values) {
    to_low += std::abs(x - extent.low);
    to_high += std::abs(extent.high - x);
  }
  for (double& x : values) x = std::abs(to_low < to_high ? x - extent.low : extent.high - x);
}

struct Trial {
  FootprintRectangle rectangle;
  double score = 0;
};

Trial tryYaw(const std::vector<Eigen::Vector2d>& points, double yaw) {
  const Eigen::Vector2d first(std::cos(yaw), std::sin(yaw)), second(-first.y(), first.x());
  std::vector<double> a, b;
  const Extent ea = extentAlong(points, first, a), eb = extentAlong(points, second, b);
  distancesToSide(a, ea);
  distancesToSide(b, eb);
  double closeness = 0;
  for (std::size_t i = 0; i < points.size(); ++i) closeness += 1 / std::max(kLeastDistance_m, std::min(a[i], b[i]));
  const double area = std::max(ea.size(), kLeastSide_m) * std::max(eb.size(), kLeastSide_m);
  Trial trial;
  trial.rectangle.center = first * (ea.low + ea.high) / 2 + second * (eb.low + eb.high) / 2;
  trial.rectangle.yaw = yaw;
  trial.rectangle.size_first = ea.size();
  trial.rectangle.size_second = eb.size();
  trial.score = closeness / static_cast<double>(points.size()) / std::sqrt(area);
  return trial;
}

}  // namespace

std::vector<FootprintRectangle> fitRectangles(const std::vector<Eigen::Vector2d>& points,
                                              const VerticalFaces& faces, int max_count) {
  std::vector<FootprintRectangle> out;
  if (points.size() < kLeastFootprint) return out;
  std::vector<Trial> trials;
  for (int k = 0; k < kSteps; ++k) {
    trials.push_back(tryYaw(points, k * std::numbers::pi / 2 / kSteps));
    trials.back().score *= kWithoutFaces + faceAgreement(faces, trials.back().rectangle.yaw);
  }
  std::vector<Trial> peaks;
  for (int k = 0; k < kSteps; ++k) {
    bool peak = true;
    for (int step = -kPeakReach; step <= kPeakReach; ++step)
      if (trials[(k + step + kSteps) % kSteps].score > trials[k].score) peak = false;
    if (peak) peaks.push_back(trials[k]);
  }
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const Trial& a, const Trial& b) { return a.score > b.score; });
  for (const Trial& peak : peaks)
    if (static_cast<int>(out.size()) < max_count) out.push_back(peak.rectangle);
  return out;
}

}  // namespace roomgraph
