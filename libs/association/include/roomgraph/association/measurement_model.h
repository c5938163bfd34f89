// SPDX-License-Identifier: BSD-3-Clause
// Likelihood of a measurement given a landmark or a new object: place, class and box.
#pragma once

#include <optional>
#include <vector>

#include "roomgraph/association/landmark_identity.h"
#include "roomgraph/association/world_measurement.h"
#include "roomgraph/core/parameters.h"
#include "roomgraph/observations/landmark.h"

namespace roomgraph {

/// Alternatives of a measurement, each with its density in 1/m^2 (not normalised).
struct Alternatives {
  WeightedLandmarks same_class;   ///< landmarks of its class in gate, in the order of the map
  WeightedLandmarks other_class;  ///< landmarks of another class at its position: its label may be wrong
  double fresh = 0;               ///< an object that has no landmark yet
};

/// Density of a detection's box given the measurement's own proposal, in the units of boxRatio(); nothing without a box or
/// camera, and where it is not known yet.
using OwnBox = std::optional<double>;

/// p(b | x, l) and omega of method.md sec. 4: how well a measurement fits the landmarks around it.
struct MeasurementModel {
  double gate_sigma = 5;
  double new_density_per_m2 = 0.05;
  double shared_error_m = 0.06;
  double tail_degrees = 3;
  double wrong_label = 0.05;
  double wrong_depth = 0.5;
  double box_sigma = 0.2;
  double hidden_side = 0.2;

  void declare(ParameterVisitor& visitor);

  /// Squared Mahalanobis distance on the ground, with the covariance of both and the error that all sightings
  /// from one side share.
  double squaredDistance(const WorldMeasurement& seen, const Landmark& landmark) const;

  /// Whether the measurement can be the landmark: class, and gate or viewing ray.
  bool inGate(const WorldMeasurement& seen, const Landmark& landmark) const;

  /// Density of the measured position given the landmark, 1/m^2: a bivariate Student t, because some proposals are
  /// outliers of their covariance; mixed with a stripe along the viewing ray, for proposals whose depth is that of
  /// something in front or behind (more probable at low scores), weighted by the boxRatio.
  double density(const WorldMeasurement& seen, const Landmark& landmark, const OwnBox& own = {}) const;

  /// Likelihood ratio of the detection's box given the landmark and given the proposal: of the densities of the four
  /// sides, each a Gaussian around the side of the projected model mixed with a uniform density, for sides that are
  /// hidden or include something else. Sides on the image border are left out. 1 without a camera.
  double boxRatio(const WorldMeasurement& seen, const Landmark& landmark, const OwnBox& own = {}) const;
  /// What of it is the same for every landmark.
  OwnBox ownBox(const WorldMeasurement& seen) const;

  /// The Student t alone.
  double placeDensity(const WorldMeasurement& seen, const Landmark& landmark) const;

  /// Probability that the measured depth is the landmark's own, given that the measurement is the landmark.
  double depthTrust(const WorldMeasurement& seen, const Landmark& landmark) const;

  Alternatives alternatives(const WorldMeasurement& seen, const std::vector<Landmark>& landmarks, const OwnBox& own = {}) const;
};

}  // namespace roomgraph
