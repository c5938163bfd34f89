// SPDX-License-Identifier: BSD-3-Clause
// How an unknown size spreads a proposal's place.
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

Eigen::Matrix2d placeSpread(const PlaceBySize& by_size, double yaw, const Eigen::Vector3d& size_information,
                            const Eigen::Vector3d& size_sigma) {
  const Eigen::Vector3d variance = (size_information + size_sigma.cwiseAbs2().cwiseInverse()).cwiseInverse();
  const PlaceBySize turned = Eigen::Rotation2Dd(yaw).toRotationMatrix() * by_size;
  return turned * variance.asDiagonal() * turned.transpose();
}

}  // namespace roomgraph
