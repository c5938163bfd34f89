// SPDX-License-Identifier: BSD-3-Clause
// Door on a vertical plane: interval between the box sides, with covariance.
#pragma once

#include <optional>

#include "roomgraph/proposals/placed_shape.h"
#include "roomgraph/proposals/shape_fit.h"
#include "vertical_plane.h"

namespace roomgraph {

/// Ends of an interval as the sides of a box show them, with their standard deviations, m. An end that is cut is there
/// or beyond.
struct SeenInterval {
  double low = 0, high = 0;
  double low_sigma = 0, high_sigma = 0;
  bool low_cut = false, high_cut = false;
};

/// Centre and width of an interval, with the centre's standard deviation, m.
struct Interval {
  double center = 0, width = 0;
  double center_sigma = 0;
  double width_information = 0;  ///< 1/m^2, of what was seen alone
  double center_by_width = 0;    ///< change of the centre by that of the width: one end may be fixed
};

/// Least squares of both ends and the usual width (mean, standard deviation; m). When both ends are cut, the centre has
/// a large standard deviation.
Interval fitInterval(const SeenInterval& seen, double usual_width, double width_sigma);

/// Standard deviation of a box's side, px, by the box's extent across it: as in the fit of other shapes.
inline double sideSigma(double extent_px) {
  const FitWeights fit;
  return fit.box_side_px + fit.box_side_share * extent_px;
}

/// Puts a door at this coordinate along the plane, its middle `seat_m` behind it and its front as the
/// plane's.
void standOn(PlacedShape& door, const VerticalPlane& plane, double along_m, double seat_m);

/// A door between the sides of the box on the plane, `seat_m` behind which its middle is, with its
/// covariance: across the plane from the plane's and as much as `seat_m`, which is a guess, along it from the
/// box's sides at this viewing angle. Nothing when the plane is seen edge-on, or the ray of a side of the box
/// does not meet it.
std::optional<PlacedShape> doorOnPlane(const VerticalPlane& plane, const BoxEvidence& evidence,
                                       double seat_m);

}  // namespace roomgraph
