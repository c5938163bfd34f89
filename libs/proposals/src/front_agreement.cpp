// SPDX-License-Identifier: BSD-3-Clause
// Front of an object from its high back or from the side that is seen.
#include "front_agreement.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph {
namespace {

constexpr double kMiddleShare = 0.3;  // of the width, to both sides: arm rests may be as high as the back
constexpr double kTop = 0.97;         // quantile of the heights taken for the object's top
constexpr double kHighShare = 0.8;    // of the top: points above it belong to the back rest
constexpr double kLowShare = 0.6;     // of that height: points below it belong to the seat
constexpr int kFewInPart = 5;         // fewer of them tell nothing
// Weight, without depth, of the assumption that a seat faces the camera rather than the wall behind it.
constexpr double kBlindWeight = 0.3;

// 1: the front faces the camera; -1: it faces away.
double facesCamera(const PlacedShape& placed) {
  return -std::cos(placed.yaw - std::atan2(placed.y, placed.x));
}

}  // namespace

double backRestAgreement(const PlacedShape& placed, const std::vector<MaskPoint>& points) {
  const Pose3 object_from_ground = groundFromObject(placed).inverse();
  std::vector<Eigen::Vector3d> middle;
  std::vector<double> heights;
  for (const auto& p : points) {
    const Eigen::Vector3d q = object_from_ground * p.in_ground;
    if (std::abs(q.y()) > kMiddleShare * placed.shape.width) continue;
    middle.push_back(q);
    heights.push_back(q.z());
  }
  const double high = kHighShare * quantile(heights, kTop), low = kLowShare * high;
  double high_sum = 0, low_sum = 0;
  int high_count = 0, low_count = 0;
  for (const auto& q : middle) {
    if (q.z() >= high) high_sum += q.x(), ++high_count;
    if (q.z() <= low) low_sum += q.x(), ++low_count;
  }
  if (high_count < kFewInPart) return 0;
  const double back = high_sum / high_count, seat = low_count < kFewInPart ? back : low_sum / low_count;
  return std::clamp((seat - 2 * back) / (placed.shape.depth / 2), -1.0, 1.0);
}

double frontAgreement(const PlacedShape& placed, const BoxEvidence& evidence) {
  switch (evidence.model->frontRule()) {
    case FrontRule::kHighBack:
      return evidence.mask.points.empty() ? kBlindWeight * facesCamera(placed)
                                          : backRestAgreement(placed, evidence.mask.points);
    case FrontRule::kNearSide:
      return facesCamera(placed);
    case FrontRule::kNone:
      break;
  }
  return 0;
}

}  // namespace roomgraph
