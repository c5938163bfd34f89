// SPDX-License-Identifier: BSD-3-Clause
// Student-t place density, viewing-ray density for failed depth, gate and alternatives of a measurement.
#include "roomgraph/association/measurement_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roomgraph {
namespace {

constexpr double kSamePlace = 0.5;  // share of the smaller footprint
constexpr double kMostSuppression =
    0.98;  // cap on how much an existing landmark suppresses "new" at its place
constexpr double kRayLength_m = 8;
constexpr double kLeastRange_m = 0.3;  // nearer: no viewing ray

Eigen::Vector2d apart(const WorldMeasurement& seen, const Landmark& landmark) {
  return (seen.world_from_object.translation() - landmark.position).head<2>();
}

Eigen::Matrix2d jointCovariance(const WorldMeasurement& seen, const Landmark& landmark, double shared) {
  return seen.covariance.topLeftCorner<2, 2>() + landmark.covariance.topLeftCorner<2, 2>() +
         shared * shared * Eigen::Matrix2d::Identity();
}

// Surely out of the gate: even along the largest variance, which is at most the sum of both.
bool isFar(const WorldMeasurement& seen, const Landmark& landmark, double shared, double gate) {
  constexpr double kRounding = 1.01;
  return apart(seen, landmark).squaredNorm() > kRounding * gate * gate * jointCovariance(seen, landmark, shared).trace();
}

// Whether a stands on b, or hangs above it. Heights are estimates.
bool isAbove(const ObjectShape& a, const Pose3& world_from_a, const ObjectShape& b, const Pose3& world_from_b) {
  constexpr double kSunk = 0.25;  // share of the lower one's height
  const double top_of_b = world_from_b.translation().z() + b.height;
  return world_from_a.translation().z() > top_of_b - kSunk * std::min(a.height, b.height);
}

// From the camera through the place that was measured, on the ground.
struct ViewingRay {
  Eigen::Vector2d camera = Eigen::Vector2d::Zero(), along = Eigen::Vector2d::Zero();  // m, world; a unit vector
  double range = 0;                                                                   // of the place, m
};

ViewingRay viewingRay(const WorldMeasurement& seen) {
  const Pose3 world_from_camera =
      seen.world_from_object * seen.measurement.proposal.camera_from_object.inverse();
  ViewingRay out{.camera = world_from_camera.translation().head<2>()};
  const Eigen::Vector2d ray = seen.world_from_object.translation().head<2>() - out.camera;
  out.range = ray.norm();
  if (!(out.range < kLeastRange_m)) out.along = ray / out.range;
  return out;
}

// Density of a place anywhere on the viewing ray that passes the landmark, 1/m^2; 0 off the ray.
double rayDensity(const WorldMeasurement& seen, const ViewingRay& ray, const Landmark& landmark, double shared, double gate) {
  if (ray.range < kLeastRange_m) return 0;
  const Eigen::Vector2d across(-ray.along.y(), ray.along.x());
  const Eigen::Vector2d gap = landmark.position.head<2>() - ray.camera;
  const double landmark_range = ray.along.dot(gap);
  if (landmark_range < kLeastRange_m || landmark_range > kRayLength_m) return 0;
  const double variance = across.dot(jointCovariance(seen, landmark, shared) * across) *
                          std::max(1.0, std::pow(landmark_range / ray.range, 2));
  const double squared = std::pow(across.dot(gap), 2) / variance;
  if (squared > gate * gate) return 0;
  return std::exp(-squared / 2) / std::sqrt(2 * std::numbers::pi * variance) / kRayLength_m;
}

}  // namespace

double footprintOverlap(const ObjectShape& a, const Pose3& world_from_a, const ObjectShape& b,
                        const Pose3& world_from_b) {
  if (isAbove(a, world_from_a, b, world_from_b) || isAbove(b, world_from_b, a, world_from_a)) return 0;
  const auto base_a = footprintAt(planarPart(world_from_a), a);
  const auto base_b = footprintAt(planarPart(world_from_b), b);
  const double smaller = std::min(polygonArea(base_a), polygonArea(base_b));
  return smaller > 0 ? polygonArea(intersectConvex(base_a, base_b)) / smaller : 0;
}

void MeasurementModel::declare(ParameterVisitor& v) {
  v.add("gate_sigma", gate_sigma,
        {.doc = "Farther landmarks, in standard deviations (Mahalanobis distance), are "
                "not candidates.",
         .min = 0.5,
         .max = 20});
  v.add("new_density_per_m2", new_density_per_m2,
        {.doc = "Prior density of new objects of one class on the floor.",
         .unit = "1/m^2",
         .min = 1e-6,
         .max = 100});
  v.add("shared_error_m", shared_error_m,
        {.doc = "Standard deviation of the error of position that all sightings from one side share.",
         .unit = "m",
         .min = 0,
         .max = 2});
  v.add("tail_degrees", tail_degrees,
        {.doc = "Degrees of freedom of the Student t density of a measured position. Few: narrow core, heavy "
                "tails.",
         .min = 2.1,
         .max = 1000});
  v.add("wrong_label", wrong_label,
        {.doc = "Probability that the detector names an object of another class.", .min = 1e-6, .max = 0.5});
  v.add("wrong_depth", wrong_depth,
        {.doc = "Probability that a proposal of score 0 has the depth of something in front or behind.",
         .min = 0,
         .max = 0.99});
  v.add("box_sigma", box_sigma,
        {.doc = "Standard deviation of a side of a detection's box, as a share of the box's width or height.",
         .min = 0.01,
         .max = 10});
  v.add(
      "hidden_side", hidden_side,
      {.doc = "Probability that a side of the box is not the end of the object, because something hides it.",
       .min = 0.001,
       .max = 1});
}

double MeasurementModel::squaredDistance(const WorldMeasurement& seen, const Landmark& landmark) const {
  const Eigen::Vector2d gap = apart(seen, landmark);
  return gap.dot(jointCovariance(seen, landmark, shared_error_m).inverse() * gap);
}

bool MeasurementModel::inGate(const WorldMeasurement& seen, const Landmark& landmark) const {
  if (landmark.class_name != seen.measurement.proposal.class_name) return false;
  return squaredDistance(seen, landmark) <= gate_sigma * gate_sigma ||
         (wrong_depth > 0 && rayDensity(seen, viewingRay(seen), landmark, shared_error_m, gate_sigma) > 0);
}

double MeasurementModel::placeDensity(const WorldMeasurement& seen, const Landmark& landmark) const {
  // The t distribution that has the joint covariance: its scale matrix is smaller by this factor.
  const double scale = (tail_degrees - 2) / tail_degrees;
  const double squared = squaredDistance(seen, landmark) / scale;
  const double determinant = jointCovariance(seen, landmark, shared_error_m).determinant();
  return std::pow(1 + squared / tail_degrees, -(tail_degrees + 2) / 2) /
         (2 * std::numbers::pi * scale * std::sqrt(determinant));
}

namespace {

// `on_ray`: the landmark's rayDensity().
double densityWith(const MeasurementModel& model, const WorldMeasurement& seen, const Landmark& landmark, double on_ray, const OwnBox& own) {
  const double failed = model.wrong_depth * (1 - std::clamp(seen.measurement.proposal.score, 0.0, 1.0));
  // The proposal's position already contains the information of box and depth; the box adds some only where the depth
  // is an outlier.
  return (1 - failed) * model.placeDensity(seen, landmark) +
         (on_ray > 0 ? failed * on_ray * model.boxRatio(seen, landmark, own) : 0);
}

}  // namespace

double MeasurementModel::density(const WorldMeasurement& seen, const Landmark& landmark, const OwnBox& own) const {
  return densityWith(*this, seen, landmark, rayDensity(seen, viewingRay(seen), landmark, shared_error_m, gate_sigma), own);
}

double MeasurementModel::depthTrust(const WorldMeasurement& seen, const Landmark& landmark) const {
  const double failed = wrong_depth * (1 - std::clamp(seen.measurement.proposal.score, 0.0, 1.0));
  const double own = (1 - failed) * placeDensity(seen, landmark);
  const double whole = own + failed * rayDensity(seen, viewingRay(seen), landmark, shared_error_m, gate_sigma);
  return whole > 0 ? own / whole : 1 - failed;
}

Alternatives MeasurementModel::alternatives(const WorldMeasurement& seen,
                                            const std::vector<Landmark>& landmarks, const OwnBox& own) const {
  const auto& proposal = seen.measurement.proposal;
  Alternatives out;
  out.fresh = new_density_per_m2;
  const double extent = proposal.shape.horizontalExtent();
  const ViewingRay ray = viewingRay(seen);
  for (const auto& landmark : landmarks) {
    if (landmark.class_name == proposal.class_name) {
      const double on_ray = wrong_depth > 0 ? rayDensity(seen, ray, landmark, shared_error_m, gate_sigma) : 0;
      const bool in_gate = on_ray > 0 ||
                           (!isFar(seen, landmark, shared_error_m, gate_sigma) && squaredDistance(seen, landmark) <= gate_sigma * gate_sigma);
      if (in_gate) out.same_class.emplace_back(landmark.id, densityWith(*this, seen, landmark, on_ray, own));
      continue;
    }
    if (apart(seen, landmark).norm() > extent + landmark.shape.horizontalExtent()) continue;
    const double overlap =
        footprintOverlap(proposal.shape, seen.world_from_object, landmark.shape, landmark.worldFromObject());
    if (overlap < kSamePlace) continue;
    // Two objects cannot be in one place: a landmark of high existence makes "new" improbable there.
    const double area = std::max(0.1, landmark.shape.width * landmark.shape.depth);
    out.other_class.emplace_back(landmark.id, wrong_label * landmark.existence / area);
    out.fresh *= 1 - kMostSuppression * landmark.existence;
  }
  return out;
}

}  // namespace roomgraph
