// SPDX-License-Identifier: BSD-3-Clause
// Fault: a cupboard that is pushed through the room, drawn into scans, depth images and pictures.
#pragma once

#include <optional>

#include "fault.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// A box that stands on the floor and is pushed to and fro across the robot's way while the fault lasts.
struct MovingBox {
  Pose3 odom_from_robot = Pose3::Identity();  ///< when it began
  double speed_m_s = 0.25;

  static constexpr double kDepth_m = 0.4, kWidth_m = 0.6, kHeight_m = 1.2;
  static constexpr double kAhead_m = 1.8, kAside_m = 1;  ///< of the robot: its middle, and how far it goes to either side

  /// Of its middle on the floor, x along its depth and y along its width, so many seconds after the beginning.
  Pose3 odom_from_box(double seconds) const;
};

/// Where a ray from outside enters a MovingBox, in lengths of `direction`; nothing when it does not. Both in the box's frame.
std::optional<double> entersBox(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

/// Puts a MovingBox into what camera and lidar see, where the wheels (the first ones of the recording) say that the robot is: nothing before the first reading of them,
/// and nothing while the robot would stand in it. Recorded detections stay as they are.
class MovingFurnitureFault : public Fault {
 public:
  MovingFurnitureFault(FaultWindow window, double speed_m_s) : window_(window) { box_.speed_m_s = speed_m_s; }
  PassingRecords pass(PassingRecord record) override;
  std::string needs() const override { return "odometry before it begins"; }

 private:
  void remember(const PassingRecord& record);
  Pose3 robotAt(double t) const;

  struct Reading {
    double t = 0;
    Pose2 odom_from_robot;
  };
  FaultWindow window_;
  MovingBox box_;
  bool begun_ = false;
  std::optional<Reading> last_, before_;
  std::string label_;  ///< of the wheels that count: the first ones
};

}  // namespace roomgraph
