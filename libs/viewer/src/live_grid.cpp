// SPDX-License-Identifier: BSD-3-Clause
// The thread that takes scans and poses and builds the grid, at growing intervals.
#include "live_grid.h"

#include <algorithm>
#include <chrono>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using GridClock = std::chrono::steady_clock;
constexpr std::size_t kMostWaitingFrames = 30;

/// At first often, later a tenth of the time so far: every grid is kept for those who go back.
GridClock::duration pauseAfter(GridClock::duration since_start, GridClock::duration last_build) {
  using std::chrono::seconds;
  const GridClock::duration tenth =
      std::clamp<GridClock::duration>(since_start / 10, seconds(1), seconds(20));
  return std::max(tenth, 4 * last_build);
}

}  // namespace

LiveGrid::LiveGrid(const OccupancyOptions& options) : mapper_(options), thread_([this] { work(); }) {}

LiveGrid::~LiveGrid() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void LiveGrid::add(Job job) {
  const std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(job));
}

void LiveGrid::add(const Scan& scan) {
  add([scan](OccupancyMapper& mapper) { mapper.add(scan); });
}

void LiveGrid::add(const Frame& frame, const Plane& ground, const std::vector<Box2>& moving) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() > kMostWaitingFrames) return;
  }
  changed_.notify_all();
  add([frame, ground, moving](OccupancyMapper& mapper) { mapper.add(frame, ground, moving); });
}

void LiveGrid::build(Trajectory world_from_robot) {
  const std::lock_guard lock(mutex_);
  poses_ = std::move(world_from_robot);
  due_ = false;
  changed_.notify_all();
}

std::shared_ptr<const LiveGrid::Grid> LiveGrid::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

void LiveGrid::work() {
  const auto start = GridClock::now();
  auto next = start;
  std::unique_lock lock(mutex_);
  while (!stopped_) {
    const std::vector<Job> jobs = std::exchange(waiting_, {});
    const auto poses = std::exchange(poses_, std::nullopt);
    lock.unlock();
    for (const Job& job : jobs) job(mapper_);
    std::shared_ptr<const Grid> grid;
    if (poses) {
      const auto begun = GridClock::now();
      try {
        grid = mapper_.build(*poses);
      } catch (const RunError&) {  // too large to be right: a lost robot; the run goes on
      }
      next = GridClock::now() + pauseAfter(GridClock::now() - start, GridClock::now() - begun);
    }
    lock.lock();
    if (grid) newest_ = grid;
    if (!poses_ && GridClock::now() >= next) due_ = true;
    if (!stopped_ && !poses_) changed_.wait_for(lock, std::chrono::milliseconds(200));
  }
}

}  // namespace roomgraph
