// SPDX-License-Identifier: BSD-3-Clause
// OwnShare: how much of a lidar's errors returns beside each other do not have in common.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "planar_scan.h"

namespace roomgraph {

/// How far a return is from the line that it belongs to.
struct LineError {
  bool known = false;                                    ///< there is a line, and it is not far off
  double sigmas = 0;                                     ///< signed, along the normal
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
};

/// Sums over pairs of neighbouring returns: half the squared difference of their errors, and half the sum of their squares.
struct NeighbourErrors {
  double apart = 0, all = 0;
};
/// Of the returns that lie on one piece of a surface. `points` in the order of the beams, with an error for each.
NeighbourErrors neighbourErrors(const Points2& points, const std::vector<LineError>& errors);

/// Follows it over scans: errors that beams make by chance differ from each other, those of the range's calibration, of the incidence and
/// of the surface are alike. Simulated beams err on their own (.8 and more); of real lidars it is a third to a half.
class OwnShare {
 public:
  /// In (0, 1]. Some 50 scans back.
  double value() const;
  void learn(const NeighbourErrors& errors);

 private:
  static constexpr double kUsual = 0.2, kPairs = 200;  ///< before anything is seen, and how much that counts
  double apart_ = kUsual * kPairs, all_ = kPairs;
};

/// Returns that are closer to each other lie on one piece of a surface.
inline constexpr double kAlike_m = 0.1;

}  // namespace roomgraph
