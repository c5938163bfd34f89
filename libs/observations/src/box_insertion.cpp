// SPDX-License-Identifier: BSD-3-Clause
// Boxes brought onto the floor, and a filter of landmarks for known poses.
#include "box_insertion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "roomgraph/geometry/box_sides.h"
#include "roomgraph/geometry/ground.h"

namespace roomgraph {
namespace {

constexpr double kTilt_rad = 0.01;                        ///< of the camera, standard deviation
constexpr double kSightingGain = 5, kNeutralScore = 0.2;  ///< log odds of a sighting, method.md sec. 4.2
constexpr double kSurest = 0.99;

double addedEvidence(double existence, double score) {
  const double gain = kSightingGain * (score - kNeutralScore);
  if (gain > 0 && existence >= kSurest) return existence;
  const double p = std::clamp(existence, 1 - kSurest, kSurest);
  return std::min(kSurest, 1 / (1 + std::exp(-std::log(p / (1 - p)) - gain)));
}

double squaredDistance(const Landmark& a, const Landmark& b) {
  const Eigen::Vector2d gap = a.position.head<2>() - b.position.head<2>();
  const Eigen::Matrix2d covariance = a.covariance.topLeftCorner<2, 2>() + b.covariance.topLeftCorner<2, 2>();
  return gap.dot(covariance.ldlt().solve(gap));
}

void fuse(const Landmark& sighting, double score, Landmark& landmark) {
  const Eigen::Matrix2d before = landmark.covariance.topLeftCorner<2, 2>();
  const Eigen::Matrix2d gain = before * (before + sighting.covariance.topLeftCorner<2, 2>()).inverse();
  landmark.position.head<2>() += gain * (sighting.position.head<2>() - landmark.position.head<2>());
  const Eigen::Matrix2d after = (Eigen::Matrix2d::Identity() - gain) * before;
  landmark.covariance.topLeftCorner<2, 2>() = (after + after.transpose()) / 2;
  landmark.existence = addedEvidence(landmark.existence, score);
  const double votes = landmark.observations;
  for (auto& [name, probability] : landmark.class_posterior) probability *= votes / (votes + 1);
  landmark.class_posterior[sighting.class_name] += 1 / (votes + 1);
  ++landmark.observations;
}

}  // namespace

std::optional<Landmark> placedByBox(const Box2& box, const ObjectModel& model, const PinholeCamera& camera,
                                    const Pose3& world_from_camera, const MapLikelihoodOptions& noise) {
  const BoxSides inside = sidesInside(box, camera);
  if (!model.rests_on_ground || !inside.left || !inside.right || !inside.bottom) return std::nullopt;
  const Eigen::Vector3d ray = camera.ray(box.center().x(), box.v_max);
  const auto meets = intersect(ray, groundInCamera(world_from_camera));
  if (!meets) return std::nullopt;
  const Eigen::Vector2d eye = world_from_camera.translation().head<2>();
  const Eigen::Vector2d view = (world_from_camera * *meets).head<2>() - eye;
  const double near_range = view.norm(), height = world_from_camera.translation().z();
  if (near_range > noise.far_m || near_range < 1e-6) return std::nullopt;

  Landmark out;
  out.class_name = model.class_name;
  out.model = model.class_name;
  out.shape = model.nominal();
  const bool flat = out.shape.kind == ShapeKind::kPlanar;
  const double behind = flat ? 0 : (out.shape.width + out.shape.depth) / 4;
  const Eigen::Vector2d direction = view / near_range, across(-direction.y(), direction.x());
  const double range = near_range + behind;
  out.position.head<2>() = eye + range * direction;
  const double side_px = std::hypot(noise.side_sigma_px, noise.box_sigma * box.height());
  const double along = std::hypot(
      (near_range * near_range + height * height) / height * std::hypot(kTilt_rad, side_px / camera.fy),
      std::abs(out.shape.width - out.shape.depth) / 4);
  const double aside = range * std::hypot(noise.side_sigma_px, noise.box_sigma * box.width()) / camera.fx;
  out.covariance.setZero();
  out.covariance.topLeftCorner<2, 2>() =
      along * along * direction * direction.transpose() + aside * aside * across * across.transpose();
  out.covariance(2, 2) = 1e-4;
  out.covariance(3, 3) = std::numbers::pi * std::numbers::pi / 3;  // of a uniform angle
  return out;
}

std::optional<LandmarkId> insertSighting(const Landmark& sighting, double score,
                                         const MapInsertionOptions& options,
                                         std::vector<Landmark>& landmarks) {
  Landmark* nearest = nullptr;
  double least = options.gate_sigma * options.gate_sigma;
  std::int64_t next = 0;
  for (Landmark& landmark : landmarks) {
    next = std::max(next, landmark.id.value + 1);
    if (landmark.class_name != sighting.class_name) continue;
    const double distance = squaredDistance(sighting, landmark);
    if (distance > least) continue;
    least = distance;
    nearest = &landmark;
  }
  if (nearest) {
    fuse(sighting, score, *nearest);
    return nearest->id;
  }
  if (score < options.new_object_score) return std::nullopt;
  landmarks.push_back(sighting);
  Landmark& fresh = landmarks.back();
  fresh.id.value = next;
  fresh.existence = addedEvidence(0.5, score);
  fresh.class_posterior = {{fresh.class_name, 1}};
  fresh.observations = 1;
  return fresh.id;
}

}  // namespace roomgraph
