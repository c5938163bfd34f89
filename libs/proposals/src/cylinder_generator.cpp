// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include <algorithm>
#include <cmath>

#include "roomgraph/proposals/fit_shape.h"
#include "roomgraph/proposals/generators.h"

namespace roomgraph {
namespace {

// The box's bottom side touches the near rim of the base; chair feet rarely point straight at the camera.
constexpr double kRim = 0.9;

PlacedShape placeAt(double bearing, double range, const BoxEvidence& e, const char* source) {
  PlacedShape placed;
  placed.shape = e.model->nominal();
  placed.x = range * std::cos(bearing);
  placed.y = range * std::sin(bearing);
  placed.source = source;
  return placed;
}

// Range of the axis from the points: half of what is seen lies before the axis only when the whole depth of
// the object is seen; of a closed surface one sees the front, which is a radius nearer than the axis.
double rangeFromPoints(const BoxEvidence& e, double bearing) {
  const Eigen::Vector2d ahead(std::cos(bearing), std::sin(bearing));
  std::vector<double> along;
  for (const auto& p : e.mask.points) along.push_back(ahead.dot(p.in_ground.head<2>()));
  const double radius = e.model->nominal().radius();
  const double front = quantile(along, 0.03) + kRim * radius, rear = quantile(along, 0.97) - kRim * radius;
  return rear > front ? (front + rear) / 2 : front;
}

// Bearing of the box's middle; with a side cut by the border, of the points' middle.
double bearingOfObject(const BoxEvidence& e) {
  if ((!e.cut_left && !e.cut_right) || e.mask.points.empty()) return bearingOf(e);
  std::vector<double> bearings;
  for (const auto& p : e.mask.points) bearings.push_back(std::atan2(p.in_ground.y(), p.in_ground.x()));
  return (quantile(bearings, 0.03) + quantile(bearings, 0.97)) / 2;
}

std::vector<PlacedShape> initialGuesses(const BoxEvidence& e) {
  std::vector<PlacedShape> out;
  const double bearing = bearingOfObject(e), radius = e.model->nominal().radius();
  if (!e.mask.points.empty()) out.push_back(placeAt(bearing, rangeFromPoints(e, bearing), e, "depth"));
  if (const auto contact = contactPoint(e); contact && e.model->rests_on_ground)
    out.push_back(placeAt(bearing, contact->norm() + kRim * radius, e, "contact"));
  // Neither depth nor a visible bottom: as far as the usual size looks as wide as the box.
  if (out.empty() && !e.cut_left && !e.cut_right && halfAngleOf(e) > 1e-3)
    out.push_back(placeAt(bearing, radius / std::sin(halfAngleOf(e)), e, "size"));
  return out;
}

}  // namespace

std::vector<PlacedShape> cylinderHypotheses(const BoxEvidence& evidence, const GeneratorLimits& limits) {
  std::vector<PlacedShape> kept;
  for (const PlacedShape& guess : initialGuesses(evidence)) {
    const PlacedShape fitted = fitShape(guess, evidence);
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const PlacedShape& other) {
      return std::hypot(other.x - fitted.x, other.y - fitted.y) < 0.05;
    });
    if (!known && fitted.box_iou >= limits.min_iou) kept.push_back(fitted);
  }
  std::stable_sort(kept.begin(), kept.end(),
                   [](const PlacedShape& a, const PlacedShape& b) { return a.quality > b.quality; });
  if (static_cast<int>(kept.size()) > limits.max_count) kept.resize(limits.max_count);
  return kept;
}

}  // namespace roomgraph
