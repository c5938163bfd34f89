// SPDX-License-Identifier: BSD-3-Clause
// Memory of free space around the robot, and the returns of a scan that contradict it.
#pragma once

#include <Eigen/StdVector>
#include <cstdint>
#include <vector>

#include "roomgraph/core/parameters.h"
#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// When space is known to be free, and for how long a return in it contradicts that.
struct FreeSpaceOptions {
  bool enabled = true;
  double cell_m = 0.1;
  double reach_m = 8;
  double free_after_s = 2;
  double settle_s = 5;
  double memory_s = 30;
  double max_share = 0.35;
  double least_width_m = 0.1;

  void declare(ParameterVisitor& v);
};

/// Detects what moves by the contradiction with free space (Wang, Thorpe and Thrun 2003; method.md sec. 5): a
/// return where many recent beams went through is on something that was not there before. Space is free when
/// its cell and all eight cells around it are: errors of pose and range next to a wall contradict nothing.
/// What stays becomes static after a while. The grid rolls with the robot, in the scan matcher's frame.
class FreeSpaceMemory {
 public:
  explicit FreeSpaceMemory(const FreeSpaceOptions& options = {});

  /// Beams of a matched scan whose returns contradict free space, in ascending order; then takes the scan
  /// into the memory. None when the scan is not level, or when so many contradict that it is the pose that is
  /// wrong. Returns nearer than `min_range_m` (the robot itself) are left out. `free_m`: how far a beam without return is known to
  /// have gone (0: nobody knows); empty: of none.
  std::vector<std::size_t> observe(const Scan& scan, const Pose2& odom_from_robot, double min_range_m = 0,
                                   const std::vector<float>& free_m = {});
  /// Nothing is known any more: poses from now on have nothing to do with those before.
  void clear();

 private:
  struct Cell {
    float free_s = 0;  ///< for how long beams have gone through, up to `free_after_s`; < 0 after a return
    float contradicted_s = 0;  ///< for how long returns have lain in it since it was free
    float passed_s = -1e9F;    ///< time of the last beam through it
    std::uint32_t scan = 0;    ///< number of the last scan that changed it or was not to change it
  };
  /// Where a beam ends, in the matcher's frame, m.
  struct Return {
    std::size_t beam;
    Eigen::Vector2d point;
    bool moving, is_hit = true;  ///< else it is only known to have gone so far
  };

  Cell& at(const Eigen::Vector2i& cell);
  Eigen::Vector2i cellOf(const Eigen::Vector2d& point) const;
  bool isFree(const Cell& cell) const;
  bool isFreeAround(const Eigen::Vector2i& cell);
  void roll(const Eigen::Vector2i& center);
  void dropThin(std::vector<Return>& returns, double beam_step_rad) const;
  std::vector<Return> returnsOf(const Scan& scan, const Pose2& odom_from_robot, double min_range_m, const std::vector<float>& free_m);
  void hit(const std::vector<Return>& returns);
  void keepSurfaces(const std::vector<Return>& returns);
  void pass(Cell& cell);
  void pass(const std::vector<Return>& returns, double beam_step_rad);

  FreeSpaceOptions options_;
  int side_ = 0;  ///< cells, a power of two
  std::vector<Cell> cells_;
  Eigen::Vector2i center_ = Eigen::Vector2i::Zero();  ///< cell of the lidar
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();  ///< of the lidar, m
  double first_t_ = 0, last_t_ = 0;
  float now_s_ = 0, step_s_ = 0;  ///< since the first scan; since the last one
  double height_m_ = 0;           ///< of the scans' plane
  double implausible_s_ = 0;      ///< for how long scans have been implausible
  std::uint32_t scan_ = 0;        ///< 0: none seen
};

}  // namespace roomgraph
