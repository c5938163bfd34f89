// SPDX-License-Identifier: BSD-3-Clause
// SpaceMemory: reduced depth images and scans of a run, asked which points of the world they saw free or
// filled.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/landmark.h"
#include "roomgraph/observations/repeated_views.h"
#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// Scans that never change: a copy of these for another thread costs little.
using KeptScans = std::vector<std::shared_ptr<const Scan>>;

/// Views of one point: rays that went on beyond it, ended at it, or ended before it; of these those that ended within 1 m of it.
struct RayCounts {
  int crossed = 0, filled = 0, hidden = 0, ended_near = 0;
};

/// Depth images and scans of a whole run with the poses as they are now.
class PosedViews {
 public:
  bool hasImages() const { return !images_.empty(); }
  /// Those of times within [first, last], s.
  PosedViews between(double first, double last) const;
  /// Of every point (world, m), by the depth images.
  std::vector<RayCounts> byImages(const std::vector<Eigen::Vector3d>& points) const;
  /// Times (s) of the images that have the landmark in good view.
  std::vector<double> timesInGoodView(const Landmark& landmark) const;
  /// Of every point on the ground (world, m), by the scans taken between the two heights.
  std::vector<RayCounts> byScans(const std::vector<Eigen::Vector2d>& points, double least_z_m,
                                 double most_z_m) const;

 private:
  friend class SpaceMemory;
  struct Image {
    double t;
    Pose3 camera_from_world;
    const PinholeCamera* camera;
    const cv::Mat* depth_mm;
  };
  struct Beams {
    Pose3 lidar_from_world;
    double z_m;
    const Scan* scan;
  };
  std::vector<Image> images_;
  std::vector<Beams> scans_;
};

/// Stores what images and scans measured, at the places where the robot had moved on: about 10 kB for an
/// image.
class SpaceMemory {
 public:
  /// Reduced by nearest pixels; left out without depth or when the robot stands where the last one was taken. The boxes of
  /// people hide what is behind them.
  void add(const Frame& frame, const Pose3& world_from_robot, const std::vector<Box2>& people = {});
  void add(const Scan& scan, const Pose3& world_from_robot);
  const KeptScans& scans() const { return scans_; }
  /// Those that repeat others, when there are more than `kept` images or scans.
  void giveUpRepeated(std::size_t kept, const Trajectory& world_from_robot);
  /// Valid until the next add() or giveUpRepeated().
  PosedViews posed(const KeyPoses& poses) const;

 private:
  struct Image {
    double t;
    Pose3 robot_from_camera;
    PinholeCamera camera;
    cv::Mat depth_mm;  ///< CV_16UC1, 0: none
  };
  std::vector<Image> images_;
  KeptScans scans_;
  GrowthWatch images_watch_, scans_watch_;
  Pose3 last_image_from_ = Pose3::Identity(), last_scan_from_ = Pose3::Identity();
};

}  // namespace roomgraph
