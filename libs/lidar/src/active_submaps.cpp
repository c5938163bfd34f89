// SPDX-License-Identifier: BSD-3-Clause
// Insertion of scans into two overlapping submaps and their completion.
#include "active_submaps.h"

#include <cmath>

namespace roomgraph {

bool MotionFilter::moved(double t_last, const Pose2& last, double t, const Pose2& pose) const {
  return t - t_last >= time_s || std::hypot(pose.x - last.x, pose.y - last.y) >= distance_m ||
         std::abs(wrapAngle(pose.yaw - last.yaw)) >= angle_rad;
}

void Submap::pack() {
  grid.finish();
  surfaces.finish();
}

std::shared_ptr<Submap> ActiveSubmaps::insert(const PlanarScan& scan, const Pose2& odom_from_robot) {
  if (active_.empty() || (active_.size() == 1 && active_.front()->insertions * 2 >= scans_per_submap_)) {
    active_.push_back(std::make_shared<Submap>(cell_m_));
    active_.back()->first_insertion = inserted_;
  }
  const FacedScan in_odom = transformed(odom_from_robot, faced(scan));
  for (const auto& submap : active_) {
    submap->grid.insert(scan, odom_from_robot, update_);
    submap->surfaces.insert(in_odom);
    ++submap->insertions;
  }
  ++inserted_;
  if (active_.front()->insertions < scans_per_submap_) return nullptr;
  std::shared_ptr<Submap> full = active_.front();
  full->finished = true;
  active_.erase(active_.begin());
  return full;
}

std::shared_ptr<Submap> ActiveSubmaps::finishAll() {
  std::shared_ptr<Submap> oldest;
  if (!active_.empty() && active_.front()->insertions * 2 >= scans_per_submap_) {
    oldest = active_.front();
    oldest->finished = true;
  }
  active_.clear();
  return oldest;
}

}  // namespace roomgraph
