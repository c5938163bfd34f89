// SPDX-License-Identifier: BSD-3-Clause
// Simulated person: articulated body and walk along a path.
#pragma once

#include "roomgraph/simulation/mesh.h"
#include "roomgraph/simulation/world.h"

namespace roomgraph {

/// Where a person is and what its limbs do.
struct PersonState {
  Pose2 pose;        ///< on the floor, x to the front
  double phase = 0;  ///< of the gait, rad; 2 pi = two steps
  bool walks = false;
};

/// Rigid parts of a person, each in its own joint's frame, and where they are in the person's frame.
class PersonModel {
 public:
  PersonModel(const Person& person, MaterialList& materials);
  const std::vector<Mesh>& parts() const { return parts_; }
  /// person_from_part, aligned with parts().
  std::vector<Pose3> pose(const PersonState& state) const;

 private:
  bool sits_, rigid_ = false;
  double scale_, hip_m_;
  std::vector<Mesh> parts_;
};

/// Walks to and fro along the path, turning around at its ends; a sitting or single-point person stays.
class PersonWalk {
 public:
  explicit PersonWalk(const Person& person);
  PersonState at(double seconds) const;

 private:
  Person person_;
  std::vector<double> lengths_;  ///< along the path up to each corner
};

}  // namespace roomgraph
