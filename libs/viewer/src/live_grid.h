// SPDX-License-Identifier: BSD-3-Clause
// LiveGrid: the occupancy grid of a run that goes on, built in a thread of its own.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "roomgraph/mapping/occupancy_mapper.h"

namespace roomgraph {

/// A run makes its grid once, at the end. For people who watch it this builds one now and then, of all scans
/// so far and with the poses as they are now; whoever hands over scans does not wait for that.
class LiveGrid {
 public:
  using Grid = mrpt::maps::COccupancyGridMap2D;
  explicit LiveGrid(const OccupancyOptions& options);
  ~LiveGrid();
  LiveGrid(const LiveGrid&) = delete;
  LiveGrid& operator=(const LiveGrid&) = delete;

  void add(const Scan& scan);
  /// See OccupancyMapper::add. Left out when the thread is too far behind: images are large.
  void add(const Frame& frame, const Plane& ground, const std::vector<Box2>& moving);
  /// Whether it is time for a new grid: then call build().
  bool due() const { return due_; }
  void build(Trajectory world_from_robot);
  /// Null: none yet.
  std::shared_ptr<const Grid> newest() const;

 private:
  using Job = std::function<void(OccupancyMapper&)>;
  void add(Job job);
  void work();

  OccupancyMapper mapper_;  ///< of the thread
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool stopped_ = false;
  std::vector<Job> waiting_;
  std::optional<Trajectory> poses_;
  std::shared_ptr<const Grid> newest_;
  std::atomic<bool> due_{true};
  std::thread thread_;
};

}  // namespace roomgraph
