// SPDX-License-Identifier: BSD-3-Clause
// Interface of data association: measurements of one frame to landmarks, with posterior.
#pragma once

#include <vector>

#include "roomgraph/association/landmark_identity.h"
#include "roomgraph/association/world_measurement.h"
#include "roomgraph/core/stage.h"

namespace roomgraph {

struct AssociationModel;

/// Decision for one measurement (method.md sec. 4, E-step).
struct Association {
  std::size_t measurement = 0;
  LandmarkId landmark;          ///< invalid: a new landmark
  double probability = 1;       ///< of the decision
  WeightedLandmarks posterior;  ///< over the gate and "new" (invalid id); sums to 1
};

/// Measurements of one frame + landmarks -> posterior over {landmarks of the class in gate} and {new}.
class Associator : public Stage {
  DEFINE_VIRTUAL_MRPT_OBJECT(Associator)
 public:
  /// One association per measurement, in order; no landmark is given to two measurements.
  virtual std::vector<Association> associate(const std::vector<WorldMeasurement>& measurements,
                                             const std::vector<Landmark>& landmarks) = 0;
  /// Called with the landmark that a measurement was fused into, perhaps a new one.
  virtual void assigned(const WorldMeasurement& measurement, LandmarkId landmark) {
    (void)measurement, (void)landmark;
  }
  /// Called after landmarks were merged or split: stored ids must be resolved again.
  virtual void identitiesChanged(const LandmarkIdentity& identity) { (void)identity; }
  /// The model by which reassociate() decides the measurements of a whole run again; null: associate() does, frame by
  /// frame.
  virtual const AssociationModel* model() const { return nullptr; }
};

}  // namespace roomgraph
