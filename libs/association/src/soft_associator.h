// SPDX-License-Identifier: BSD-3-Clause
// Probabilistic data association (paper Eq. 10) over tracks, with exclusion within a frame.
#pragma once

#include <optional>
#include <set>

#include "roomgraph/association/association_model.h"
#include "roomgraph/association/associator.h"
#include "track_memory.h"

namespace roomgraph {

/// The posterior of paper Eq. 10 (method.md sec. 4): w_kj ~ omega_kc prod_t p0^t pc^t p(b | x_i, l_j), frame
/// by frame over the measurement's track, with exact exclusion inside a frame.
class SoftAssociator : public Associator {
  DEFINE_MRPT_OBJECT(SoftAssociator, roomgraph)
 public:
  void declareParameters(ParameterVisitor& visitor) override { model_.declare(visitor); }
  std::vector<Association> associate(const std::vector<WorldMeasurement>& measurements,
                                     const std::vector<Landmark>& landmarks) override;
  void assigned(const WorldMeasurement& measurement, LandmarkId landmark) override;
  void identitiesChanged(const LandmarkIdentity& identity) override;
  const AssociationModel* model() const override { return &model_; }

 private:
  double newSpaceGain(double t) const;

  AssociationModel model_;
  std::set<LandmarkId> doors_;        ///< that were ever assigned
  std::optional<double> new_door_t_;  ///< when the latest of them was first, s
  TrackMemory tracks_;
  FeatureOwners features_;
};

}  // namespace roomgraph
