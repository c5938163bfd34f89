// SPDX-License-Identifier: BSD-3-Clause
// Edges of MRPT's pose networks from movements with covariance, and back.
#pragma once

#include <mrpt/poses/CPose3DPDFGaussianInf.h>
#include <mrpt/poses/CPosePDFGaussianInf.h>

#include "roomgraph/estimation/motion.h"

namespace roomgraph {

// MRPT's constraints hold the information of the parameters of the relative pose: (x, y, phi) or (x, y, z, yaw,
// pitch, roll), m and rad, translation in frame a. A Movement has the covariance of (translation in frame a,
// rotation vector in frame b).

/// The part in the plane; what is correlated with height and tilt is marginalised.
void toConstraint(const Movement& movement, mrpt::poses::CPosePDFGaussianInf& constraint);
/// Yaw, pitch and roll to first order about the movement; not for a pitch of 90 degrees.
void toConstraint(const Movement& movement, mrpt::poses::CPose3DPDFGaussianInf& constraint);

/// Height and tilt, which a planar constraint does not measure, get a variance of 0.25. Directions without
/// information get a variance of 10^9, so that the covariance exists.
Movement toMovement(const mrpt::poses::CPosePDFGaussianInf& constraint);
Movement toMovement(const mrpt::poses::CPose3DPDFGaussianInf& constraint);

/// Columns: the rotation vector, in the turned frame, of a small change of yaw, of pitch and of roll.
Eigen::Matrix3d rotationByYawPitchRoll(double pitch, double roll);

}  // namespace roomgraph
