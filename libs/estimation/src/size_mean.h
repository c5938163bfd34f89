// SPDX-License-Identifier: BSD-3-Clause
// Size of a landmark as it was measured from one direction, without what its class says.
#pragma once

#include <optional>

#include "roomgraph/backend/factors.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// Mean of sizes measured from one direction. The fit of every proposal weighs what it sees against the
/// class's usual size; the mean of many such compromises would never leave the usual size. Therefore the
/// usual size is taken out of each (information form), the rests are averaged, and it enters the graph once,
/// by sizePrior(). Likewise the mean of the sizes that it has at least.
class SizeMean {
 public:
  /// A proposal of the model's class. `weight`: of the sighting, in [0, 1].
  void add(const Proposal& proposal, const ObjectModel& model, double weight);
  bool empty() const { return weight_ <= 0; }
  /// As sure as one of its sightings, whatever their number: their errors repeat. Not empty.
  LandmarkSizeFactor factor(LandmarkId id) const;
  /// Nothing when no end was out of view.
  std::optional<LandmarkSizeFactor> leastSize(LandmarkId id) const;

 private:
  struct Sum {
    Eigen::Vector3d information = Eigen::Vector3d::Zero(), vector = Eigen::Vector3d::Zero();  // 1/m^2, 1/m
    void add(double weight, const Eigen::Vector3d& measured, const Proposal& proposal, const ObjectModel& model);
  };
  LandmarkSizeFactor mean(const Sum& sum, LandmarkId id) const;

  Sum measured_, least_;
  Eigen::Vector3d usual_ = Eigen::Vector3d::Zero();  // m
  double weight_ = 0, largest_ = 0;
};

/// Where the sightings of one view place the landmark, by its size: a side that all of them see is at the same place
/// whatever the size; when it is longer than it was taken for, its middle is farther from that side.
class OffsetMean {
 public:
  /// `lever`: of a sighting, in the landmark's frame. `share`: its weight in the mean place.
  void add(const PlaceBySize& lever, double share);
  /// `shape`: the size for which the sightings were placed.
  void apply(const ObjectShape& shape, LandmarkViewFactor& factor) const;

 private:
  PlaceBySize by_size_ = PlaceBySize::Zero();
  double weight_ = 0;
};

/// The class's usual size and its variation.
LandmarkSizeFactor sizePrior(LandmarkId id, const ObjectModel& model);
/// A third of the usual size, whatever was measured: two sides whose places cross would leave less than nothing between them.
LandmarkSizeFactor leastOfClass(LandmarkId id, const ObjectModel& model);

}  // namespace roomgraph
