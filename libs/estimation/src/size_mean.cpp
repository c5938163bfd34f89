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

void SizeMean::Sum::add(double weight, const Eigen::Vector3d& measured, const Proposal& proposal,
                        const ObjectModel& model) {
  const Eigen::Vector3d prior = model.sizeSigma().cwiseAbs2().cwiseInverse();
  const Eigen::Vector3d fitted = sizeOf(proposal.shape), usual = sizeOf(model.nominal());
  for (int i = 0; i < 3; ++i) {
    if (measured[i] < kLeastInformation) continue;
    information[i] += weight * measured[i];
    vector[i] += weight * ((measured[i] + prior[i]) * fitted[i] - prior[i] * usual[i]);
  }
}

void SizeMean::add(const Proposal& proposal, const ObjectModel& model, double weight) {
  measured_.add(weight, proposal.size_information, proposal, model);
  least_.add(weight, proposal.least_size_information, proposal, model);
  usual_ = sizeOf(model.nominal());
  weight_ += weight;
  largest_ = std::max(largest_, weight);
}

LandmarkSizeFactor SizeMean::mean(const Sum& sum, LandmarkId id) const {
  const double least =
      kLeastInformation * weight_;  // what was never seen is as usual, with hardly any information
  const Eigen::Vector3d information = sum.information.array() + least;
  const Eigen::Vector3d variance = (information * largest_ / weight_).cwiseInverse();
  return {id, (sum.vector + least * usual_).cwiseQuotient(information),
          variance.cwiseSqrt().cwiseMax(kLeastSigma_m)};
}

LandmarkSizeFactor SizeMean::factor(LandmarkId id) const {
  return mean(measured_, id);
}

std::optional<LandmarkSizeFactor> SizeMean::leastSize(LandmarkId id) const {
  if (least_.information.isZero()) return std::nullopt;
  LandmarkSizeFactor out = mean(least_, id);
  out.at_least = true;
  return out;
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

LandmarkSizeFactor leastOfClass(LandmarkId id, const ObjectModel& model) {
  constexpr double kBound_m = 0.003;  // less than any sum of what is measured: it holds
  return {id, sizeOf(model.nominal()) / 3, Eigen::Vector3d::Constant(kBound_m), true};
}

}  // namespace roomgraph
