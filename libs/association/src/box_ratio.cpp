// SPDX-License-Identifier: BSD-3-Clause
// Likelihood ratio of a detection's box under a landmark's projected model and under its own proposal.
#include <cmath>
#include <numbers>

#include "roomgraph/association/measurement_model.h"
#include "roomgraph/geometry/box_sides.h"
#include "roomgraph/geometry/projection.h"

namespace roomgraph {
namespace {

constexpr double kAnywhere = 2;  // extents of the box over which a hidden side is uniformly distributed

struct BoxNoise {
  double sigma, hidden;
};

// Density of one side, with lengths in units of the box's size.
double sideDensity(double gap, double size, const BoxNoise& noise) {
  const double z = gap / size / noise.sigma;
  return (1 - noise.hidden) * std::exp(-z * z / 2) / (std::sqrt(2 * std::numbers::pi) * noise.sigma) +
         noise.hidden / kAnywhere;
}

// Density of the box given the visible part of a projected model; sides on the image border are left out.
double boxDensity(const Box2& box, const std::optional<ProjectedShape>& projected,
                  const PinholeCamera& camera, const BoxNoise& noise) {
  const double far = 1e9;
  const Box2 model = projected ? projected->visible : Box2{far, far, far, far};
  const auto inside = sidesInside(box, camera);
  double density = 1;
  if (inside.left) density *= sideDensity(model.u_min - box.u_min, box.width(), noise);
  if (inside.top) density *= sideDensity(model.v_min - box.v_min, box.height(), noise);
  if (inside.right) density *= sideDensity(model.u_max - box.u_max, box.width(), noise);
  if (inside.bottom) density *= sideDensity(model.v_max - box.v_max, box.height(), noise);
  return density;
}

double densityOf(const WorldMeasurement& seen, const ObjectShape& shape, const Pose3& camera_from_shape, const BoxNoise& noise) {
  return boxDensity(seen.measurement.detection.box, projectShape(shape, camera_from_shape, seen.camera), seen.camera, noise);
}

}  // namespace

OwnBox MeasurementModel::ownBox(const WorldMeasurement& seen) const {
  const Proposal& proposal = seen.measurement.proposal;
  if (!seen.camera.valid() || seen.measurement.detection.box.empty()) return std::nullopt;
  return densityOf(seen, proposal.shape, proposal.camera_from_object, {box_sigma, hidden_side});
}

double MeasurementModel::boxRatio(const WorldMeasurement& seen, const Landmark& landmark, const OwnBox& own) const {
  const OwnBox by_itself = own ? own : ownBox(seen);
  if (!by_itself) return 1;
  const Pose3 camera_from_landmark =
      seen.measurement.proposal.camera_from_object * seen.world_from_object.inverse() * landmark.worldFromObject();
  return densityOf(seen, landmark.shape, camera_from_landmark, {box_sigma, hidden_side}) / *by_itself;
}

}  // namespace roomgraph
