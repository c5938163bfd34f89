// SPDX-License-Identifier: BSD-3-Clause
// Interfaces of scan matching and of loop closing by scans.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roomgraph/core/stage.h"
#include "roomgraph/observations/scan.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// Outcome for one scan.
struct ScanMatch {
  bool matched = false;
  std::string reason;     ///< why not: "too few returns", "no overlap", …
  Pose2 odom_from_robot;  ///< pose in the matcher's own, drifting frame
  int segment = 0;        ///< counts up after each loss: poses of two segments are unrelated
  Eigen::Matrix3d step_covariance =
      Eigen::Matrix3d::Identity();  ///< of the movement since the last scan, and of the place in the local
                                    ///< map: m, rad
  double score = 0;                 ///< share of returns explained by the local map, [0, 1]
  /// Beams with returns on what moves by itself, as the scans before show; ascending. The local map is
  /// without them.
  std::vector<std::size_t> moving;
  bool anywhere = false;  ///< begins a segment, and nothing tells where: of the movement since the last one nothing is known
};

/// Matches each scan against a local map made of the scans before it.
class ScanMatcher : public Stage {
  DEFINE_VIRTUAL_MRPT_OBJECT(ScanMatcher)
 public:
  /// `previous_from_current`: movement since the last scan as other sensors saw it; nothing when there are
  /// none.
  virtual ScanMatch match(const Scan& scan, const std::optional<Pose2>& previous_from_current) = 0;
  /// All matched poses, in the matcher's frame (planar poses as Pose3).
  virtual Trajectory trajectory() const = 0;
};

/// Finds places where the robot came back, by matching scans against older submaps.
class ScanLoopCloser : public Stage {
  DEFINE_VIRTUAL_MRPT_OBJECT(ScanLoopCloser)
 public:
  /// Takes every matched scan with its pose in the matcher's frame.
  virtual void add(const Scan& scan, const ScanMatch& match) = 0;
  /// Searches with what is known now. `world_from_robot`: by the current best trajectory, used to choose candidates
  /// and as the initial guess. Returns only closures not returned before (a_from_b of the robot, planar).
  virtual std::vector<RelativePose> search(const PoseAt& world_from_robot) = 0;
  /// Checks and refines a closure that something else proposed; nothing when the scans do not confirm it.
  virtual std::optional<RelativePose> verify(const RelativePose& proposed) {
    (void)proposed;
    return std::nullopt;
  }
  /// Nothing more comes or will be asked: the memory of what was seen is given back. prepare() begins anew.
  virtual void release() {}
};

}  // namespace roomgraph
