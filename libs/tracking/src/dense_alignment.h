// SPDX-License-Identifier: BSD-3-Clause
// Alignment of two RGB-D images by depth and brightness, for images without features.
#pragma once

#include <optional>

#include "dense_image.h"
#include "roomgraph/geometry/covariance.h"

namespace roomgraph::tracking {

/// Standard deviations of translation (m) and rotation (rad).
Vector6d sameInAllDirections(double sigma_m, double sigma_rad);

/// What is known of a movement before the images are aligned. Standard deviations are those of translation and rotation along
/// and about the reference's axes or, of a body that carries the camera, the body's.
struct DensePrior {
  Pose3 reference_from_current = Pose3::Identity();
  Vector6d sigma = sameInAllDirections(0.1, 0.1);   ///< of the last frame's step, by a velocity that hardly changes
  Vector6d unseen = sameInAllDirections(0.1, 0.1);  ///< of all that was predicted since the reference
  std::optional<Pose3> current_from_body = {};
  double plausible_m = 0.4, plausible_rad = 0.4;  ///< from where it is predicted to be; more is a likeness
};

/// Of small changes (translation, rotation): those in b's axes, in a's.
Matrix6d adjoint(const Pose3& a_from_b);

struct DenseAlignment {
  Pose3 reference_from_current = Pose3::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of (translation, rotation) in the reference's frame
  double overlap = 0;  ///< share of the current pixels with depth that the reference explains, [0, 1]
};

/// Iteratively reweighted least squares of point-to-plane distances and differences of brightness (Kerl et al.,
/// "Dense visual SLAM for RGB-D cameras", IROS 2013, with the geometric term of Chen and Medioni 1992), from coarse to
/// fine. Directions that neither measures, as along a bare wall, stay as the prior has them, with the variance of what is
/// unseen. Nothing when too few pixels meet, the two do not look alike, or the step is out of the question.
std::optional<DenseAlignment> alignDense(const DenseImage& reference, const DenseImage& current,
                                         const DensePrior& prior);

}  // namespace roomgraph::tracking
