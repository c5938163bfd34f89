// SPDX-License-Identifier: BSD-3-Clause
// Door on a vertical plane: interval between the box sides, with covariance.
#pragma once

#include <optional>

#include "roomgraph/proposals/placed_shape.h"
#include "vertical_plane.h"

namespace roomgraph {

/// What the sides of a box say about an interval: the places of its ends with their standard deviations, m.
/// An end that is cut lies there or beyond.
struct SeenInterval {
  double low = 0, high = 0;
  double low_sigma = 0, high_sigma = 0;
  bool low_cut = false, high_cut = false;
};

/// Centre and width of an interval, with the centre's standard deviation, m.
struct Interval {
  double center = 0, width = 0;
  double center_sigma = 0;
};

/// Least squares of both ends and the usual width (mean, standard deviation; m). At least one end is seen, or
/// the centre stays vague.
Interval fitInterval(const SeenInterval& seen, double usual_width, double width_sigma);

/// Standard deviation of a box's side, px, by the box's extent across it.
inline double sideSigma(double extent_px) {
  return 4 + 0.03 * extent_px;
}

/// A door whose leaf lies in the plane, between the sides of the box, with its covariance: across the plane
/// that of the plane and of the leaf's seat in its frame, along it what a pixel of the box's sides is worth
/// at this angle. Nothing when the plane is seen edge-on, or a side of the box looks past it.
std::optional<PlacedShape> doorOnPlane(const VerticalPlane& plane, const BoxEvidence& evidence);

}  // namespace roomgraph
