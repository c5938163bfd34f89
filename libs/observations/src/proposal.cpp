// SPDX-License-Identifier: BSD-3-Clause
// How an unknown size spreads a proposal's place.
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

Eigen::Matrix2d placeSpread(const PlaceBySize& by_size, const Eigen::Vector3d& size_information,
                            const Eigen::Vector3d& size_sigma) {
  const Eigen::Vector3d variance = (size_information + size_sigma.cwiseAbs2().cwiseInverse()).cwiseInverse();
  return by_size * variance.asDiagonal() * by_size.transpose();
}

}  // namespace roomgraph
