// SPDX-License-Identifier: BSD-3-Clause
// Robust batch estimate of a landmark from its sightings: Student-t position, voted yaw, weighted size.
#include <algorithm>
#include <cmath>
#include <complex>

#include "roomgraph/association/landmark_rules.h"
#include "roomgraph/association/reassociation.h"

namespace roomgraph {
namespace {

constexpr int kPlaceIterations = 8;
constexpr double kLeastTrust = 1e-3;  // keeps the mean defined when every depth is an outlier

void estimatePlace(Landmark& landmark, const std::vector<const WorldMeasurement*>& sightings,
                   const std::vector<double>& weights, const MeasurementModel& model) {
  const Eigen::Matrix3d shared = std::pow(model.shared_error_m, 2) * Eigen::Matrix3d::Identity();
  const double degrees = model.tail_degrees;
  for (int iteration = 0; iteration < kPlaceIterations; ++iteration) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const Landmark before = landmark;
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      const Eigen::Matrix3d single = (sightings[i]->covariance.topLeftCorner<3, 3>() + shared).inverse();
      const Eigen::Vector3d place = sightings[i]->world_from_object.translation();
      const Eigen::Vector3d gap = place - landmark.position;
      const double trust = std::max(kLeastTrust, model.depthTrust(*sightings[i], before));
      const double robust = trust * (degrees + 3) / (degrees + gap.dot(single * gap));
      information += weights[i] * robust * single;
      sum += weights[i] * robust * single * place;
    }
    landmark.position = information.ldlt().solve(sum);
    landmark.covariance.topLeftCorner<3, 3>() = information.inverse();
  }
  landmark.covariance.topRightCorner<3, 1>().setZero();
  landmark.covariance.bottomLeftCorner<1, 3>().setZero();
}

// The axis is the mean of the doubled angles, which are equal for front and back; the front is decided by vote.
void estimateYaw(Landmark& landmark, const std::vector<const WorldMeasurement*>& sightings,
                 const std::vector<double>& weights) {
  std::complex<double> doubled = 0;
  double information = 0;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (!sightings[i]->measurement.proposal.has_yaw) continue;
    const double weight = weights[i] / sightings[i]->covariance(3, 3);
    doubled += std::polar(weight, 2 * planarPart(sightings[i]->world_from_object).yaw);
    information += weight;
  }
  landmark.has_yaw = information > 0;
  if (!landmark.has_yaw) return;
  landmark.yaw = std::arg(doubled) / 2;
  double front = 0;
  for (std::size_t i = 0; i < sightings.size(); ++i)
    if (sightings[i]->measurement.proposal.has_yaw)
      front += weights[i] * std::cos(planarPart(sightings[i]->world_from_object).yaw - landmark.yaw);
  if (front < 0) landmark.yaw = wrapAngle(landmark.yaw + M_PI);
  landmark.covariance(3, 3) = 1 / information;
}

void estimateSize(Landmark& landmark, const std::vector<const WorldMeasurement*>& sightings,
                  const std::vector<double>& weights) {
  double total = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const double weight = weights[i] * visibleFraction(sightings[i]->measurement);
    const auto& shape = sightings[i]->measurement.proposal.shape;
    sum += weight * Eigen::Vector3d(shape.width, shape.depth, shape.height);
    total += weight;
  }
  if (total <= 0) return;
  landmark.shape.width = sum.x() / total;
  landmark.shape.depth = sum.y() / total;
  landmark.shape.height = sum.z() / total;
}

}  // namespace

void estimateLandmark(Landmark& landmark, const std::vector<const WorldMeasurement*>& sightings,
                      const std::vector<double>& weights, const MeasurementModel& model) {
  std::vector<const WorldMeasurement*> same;
  std::vector<double> shares;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (sightings[i]->measurement.proposal.class_name != landmark.class_name || weights[i] <= 0) continue;
    same.push_back(sightings[i]);
    shares.push_back(weights[i]);
  }
  landmark.observations = static_cast<int>(sightings.size());
  if (same.empty()) return;
  estimatePlace(landmark, same, shares, model);
  estimateYaw(landmark, same, shares);
  estimateSize(landmark, same, shares);
  for (int i = 0; i < 4; ++i) landmark.covariance(i, i) = std::max(landmark.covariance(i, i), kLeastVariance);
}

}  // namespace roomgraph
