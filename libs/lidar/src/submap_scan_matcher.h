// SPDX-License-Identifier: BSD-3-Clause
// Scan-to-submap matching with motion prediction.
#pragma once

#include <memory>

#include "grid_refinement.h"
#include "own_share.h"
#include "place_filter.h"
#include "roomgraph/lidar/free_space_memory.h"
#include "roomgraph/lidar/scan_matcher.h"
#include "score_pyramid.h"
#include "submap_settings.h"
#include "usual_roughness.h"

namespace roomgraph {

/// Scan-to-submap matching: a correlative search around the predicted pose, then a refinement on the
/// interpolated grid with a prior on the prediction, and one on surfaces finer than its cells. After Hess et al. 2016 (Cartographer), Olson
/// 2009 and Censi 2008. Wheel slip: where the odometry deviates from constant velocity by more than the search window,
/// the scan is matched from both predictions, and the one that explains clearly more returns is taken.
class SubmapScanMatcher : public ScanMatcher {
  DEFINE_MRPT_OBJECT(SubmapScanMatcher, roomgraph)
 public:
  void declareParameters(ParameterVisitor& visitor) override;
  void prepare() override;
  ScanMatch match(const Scan& scan, const std::optional<Pose2>& previous_from_current) override;
  Trajectory trajectory() const override { return trajectory_; }

 private:
  void declareSearch(ParameterVisitor& v);
  Pose2 predict(double t, const std::optional<Pose2>& previous_from_current) const;
  /// If the robot goes on as it went.
  Pose2 steadyPose(double t) const;
  /// Whether the prediction lies beyond the search window around the steady pose.
  double extrapolated_s() const;
  bool jumps(double t, const Pose2& predicted) const;
  /// What tells how the robot moved: others; that it hardly goes another way than before; nothing.
  enum class Led { kByOthers, kSteadily, kNot };
  GridRefinement matchTo(const Submap& submap, const PlanarScan& planar, const Points2& points, const Pose2& predicted,
                         Led led, double since_s = 0);
  /// Takes the scan over; returns the beams on what moves.
  std::vector<std::size_t> accept(const Scan& scan, const PlanarScan& planar, const Pose2& pose);
  /// A scan that is not used: what others measured leads on.
  ScanMatch ledOver(double t, const Pose2& predicted, std::string reason);
  ScanMatch lose(double t, const Pose2& predicted, bool has_prior, std::string reason);
  ScanMatch start(const Scan& scan, const PlanarScan& planar, const Pose2& pose);
  Eigen::Matrix3d stepCovariance(const GridRefinement& refinement) const;

  SubmapSettings submap_settings_;
  FreeSpaceOptions free_space_options_;
  double window_m_ = 0.15, window_rad_ = 0.20944;
  double free_window_m_ = 0.4, free_window_rad_ = 0.43633;
  double search_penalty_per_m2_ = 0.5, search_penalty_per_rad2_ = 0.5;
  double prior_per_m2_ = 2, prior_per_rad2_ = 1;
  bool led_ = true;
  double min_score_ = 0.1;
  int max_lost_scans_ = 10;
  double covariance_inflation_ = 1;
  double floor_sigma_m_ = 0.001, floor_sigma_rad_ = 0.0003;

  std::unique_ptr<ActiveSubmaps> submaps_;
  ScorePyramid pyramid_;  ///< of the submap matched against
  bool pyramid_stale_ = true;
  FreeSpaceMemory free_space_;
  UsualRoughness roughness_;
  OwnShare own_share_;
  Trajectory trajectory_;
  int segment_ = 0, lost_scans_ = 0;
  std::optional<double> last_t_;      ///< of the last scan, matched or predicted
  std::optional<double> accepted_t_;  ///< of the last scan that was matched
  bool unled_ = false;                ///< nothing measured some of the movement since then
  Pose2 last_pose_;
  PlaceFilter place_;
  double interval_s_ = 0;             ///< between the last two scans
  double kept_t_ = 0;
  Pose2 kept_pose_;
};

}  // namespace roomgraph
