// SPDX-License-Identifier: BSD-3-Clause
// Sum of the costs of movements between the same two poses, to the second order.
#pragma once

#include <optional>

#include "roomgraph/backend/factors.h"

namespace roomgraph {

/// Costs of movements between two poses, each with its residual to the first order and the weight of its robust loss at a
/// movement near all of them. Their sum is, but for a constant, the cost of one movement.
class MovementSum {
 public:
  explicit MovementSum(const Pose3& near) : near_(near) {}

  /// Of the same two poses as those before.
  void add(const BetweenFactor& factor);
  /// The factor itself when there is but one; else one without a robust loss. There must be one.
  BetweenFactor asOne() const;

 private:
  Pose3 near_;
  Matrix6d information_ = Matrix6d::Zero();
  Vector6d gradient_ = Vector6d::Zero();
  std::optional<BetweenFactor> first_;
  int count_ = 0;
};

}  // namespace roomgraph
