// SPDX-License-Identifier: BSD-3-Clause
// Fit of an upright shape to box sides, depth points and usual size; quality of a hypothesis.
#pragma once

#include "roomgraph/proposals/placed_shape.h"

namespace roomgraph {

/// Standard deviations, saturations and weights of the fit. A saturation is the number of standard deviations at which
/// a residual levels off (Geman-McClure), so that a side cut by an unseen occluder or a wrong depth point cannot pull
/// without bound. Chosen by hand; `roomgraph bench proposals` shows what a change does.
struct FitWeights {
  double box_side_px = 4, box_side_share = 0.03;  ///< sigma of a box side: constant, and share of the box's extent
  double box_side_saturation = 5;
  double out_of_view = 20;            ///< residual of each side when the shape is not in view
  double point_sigma_m = 0.03;        ///< distance of a real surface from its model, besides the depth noise
  double point_noise_gain = 2;        ///< factor on the depth sensor's noise
  double point_saturation = 4;
  double all_points = 16;             ///< all points together count as so many independent ones
  int max_points = 80;
  double near_side_gain = 2, near_side_saturation = 3;  ///< nearest range of the shape against that of the points
  double yaw_sigma_rad = 0.08;        ///< of the direction found in the depth points
  double yaw_sigma_blind_rad = 0.4;   ///< of the direction guessed without depth
  double leg_px = 3, leg_share = 0.04, leg_saturation = 3;  ///< sigma of the leg's column, by the box's width
  double max_tilt = 3;                ///< largest correction of the ground's normal, in standard deviations
};

/// How the parts of a hypothesis' quality are weighed.
struct QualityWeights {
  double outside_m = 0.15;       ///< mean distance of points outside the shape at which quality falls to 1/e
  double far_outside_m = 0.3;    ///< largest distance of a single point that counts
  double size = 0.08;            ///< factor of the squared normalised size errors in the exponent
  double edges = 0.6;            ///< share of the quality that image edges decide, without depth
  double faces = 0.5;            ///< share of the quality that the directions of vertical faces decide
  double front = 0.45;           ///< share of the quality that the front rule decides
};

/// Fits place, yaw and size of an upright shape by Levenberg-Marquardt: its projection to the box's uncut sides, its
/// volume and its near side to the mask's points, its size to the usual one of the class. Sets quality and box_iou.
PlacedShape fitShape(const PlacedShape& initial, const BoxEvidence& evidence, const FitWeights& weights = {});

/// Sets quality and box_iou of a hypothesis as it is.
void judge(PlacedShape& placed, const BoxEvidence& evidence, const QualityWeights& weights = {});

}  // namespace roomgraph
