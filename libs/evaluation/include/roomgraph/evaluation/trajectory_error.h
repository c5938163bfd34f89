// SPDX-License-Identifier: BSD-3-Clause
// Absolute trajectory error and relative pose error (Sturm et al. 2012).
#pragma once

#include <vector>

#include "roomgraph/evaluation/alignment.h"
#include "roomgraph/evaluation/statistics.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

struct TrajectoryOptions {
  double max_difference_s = 0.02;  ///< largest difference of the stamps of a pair
  bool interpolate_truth =
      false;                 ///< truth at the estimate's stamps, between neighbours up to max_gap_s apart
  bool align = true;         ///< false: both are in the same frame already
  double rpe_delta_s = 1.0;  ///< time between the two poses of a relative error
  int rpe_delta_frames = 0;  ///< > 0: that many pairs apart instead of rpe_delta_s
  double max_gap_s = 1.0;    ///< longer gaps between pairs do not count as covered
};

struct TrajectoryErrors {
  ErrorStatistics ate_m;  ///< distance of the positions after alignment
  ErrorStatistics rpe_trans_m, rpe_rot_deg;
  Pose3 truth_from_estimate = Pose3::Identity();
  int pairs = 0, truth_poses = 0, estimated_poses = 0;
  double coverage = 0;       ///< share of the truth's time span that is covered by pairs
  double matched_share = 0;  ///< share of the estimated poses that have a true one
};

/// Pairs by nearest stamp; of two estimated poses with the same nearest true pose the closer one is paired.
std::vector<PosePair> associate(const Trajectory& truth, const Trajectory& estimate,
                                const TrajectoryOptions& options);

/// Absolute and relative errors as Sturm et al. (IROS 2012) define them: ATE after alignment; the relative
/// error of the poses i and j is (truth_i^-1 truth_j)^-1 (estimate_i^-1 estimate_j). Without pairs all
/// figures are 0.
TrajectoryErrors evaluateTrajectory(const Trajectory& truth, const Trajectory& estimate,
                                    const TrajectoryOptions& options = {});

}  // namespace roomgraph
