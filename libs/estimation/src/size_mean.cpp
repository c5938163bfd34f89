// SPDX-License-Identifier: BSD-3-Clause
// Weighted mean of sizes in information form, with the prior of each taken out.
#include "size_mean.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "roomgraph/geometry/shape_math.h"

namespace roomgraph {
namespace {

constexpr double kLeastSigma_m = 0.02;      // real furniture is no box
constexpr double kLeastInformation = 1e-6;  // 1/m^2: a direction from which a dimension is not seen

}  // namespace

void SizeMean::add(const Proposal& proposal, const ObjectModel& model, double weight) {
  const Eigen::Vector3d prior = model.sizeSigma().cwiseAbs2().cwiseInverse();
  const Eigen::Vector3d measured = proposal.size_information, fitted = sizeOf(proposal.shape);
  usual_ = sizeOf(model.nominal());
  for (int i = 0; i < 3; ++i) {
    if (measured[i] < kLeastInformation) continue;
    information_[i] += weight * measured[i];
    vector_[i] += weight * ((measured[i] + prior[i]) * fitted[i] - prior[i] * usual_[i]);
  }
  weight_ += weight;
  largest_ = std::max(largest_, weight);
}

LandmarkSizeFactor SizeMean::factor(LandmarkId id) const {
  const double least =
      kLeastInformation * weight_;  // what was never seen is as usual, with hardly any information
  const Eigen::Vector3d information = information_.array() + least;
  const Eigen::Vector3d variance = (information * largest_ / weight_).cwiseInverse();
  return {id, (vector_ + least * usual_).cwiseQuotient(information),
          variance.cwiseSqrt().cwiseMax(kLeastSigma_m)};
}

void OffsetMean::add(const PlaceBySize& lever, double share) {
  by_size_ += share * lever;
  weight_ += share;
}

void OffsetMean::apply(const ObjectShape& shape, LandmarkViewFactor& factor) const {
  if (weight_ <= 0) return;
  factor.offset_by_size = -by_size_ / weight_;
  factor.offset_m = -factor.offset_by_size * sizeOf(shape);
}

LandmarkSizeFactor sizePrior(LandmarkId id, const ObjectModel& model) {
  return {id, sizeOf(model.nominal()), model.sizeSigma()};
}

}  // namespace roomgraph
