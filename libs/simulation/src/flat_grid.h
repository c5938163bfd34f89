// SPDX-License-Identifier: BSD-3-Clause
// Grid of the free floor of a flat, with clearances and shortest ways.
#pragma once

#include <opencv2/core/mat.hpp>

#include "flat_draft.h"

namespace roomgraph {

/// Cells of the floor and how far each is from walls and obstacles.
class FloorGrid {
 public:
  FloorGrid(const std::vector<PlanBox>& free, const std::vector<Polygon>& obstacles, double cell_m = 0.05);

  /// Distance to what is not free, m, rounded down by up to a cell; 0 outside.
  double clearance(const Eigen::Vector2d& at) const;
  /// Centres of all cells with at least this clearance that can be reached from `from`; empty when it has less.
  std::vector<Eigen::Vector2d> reachable(const Eigen::Vector2d& from, double clearance) const;
  /// Way from cell to cell that prefers clearance, at most 1.4 times as dear as the cheapest (weighted A*, Pohl 1970), its ends
  /// as given; empty: there is none.
  std::vector<Eigen::Vector2d> way(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double clearance) const;

 private:
  cv::Point cellOf(const Eigen::Vector2d& at) const;
  Eigen::Vector2d centre(const cv::Point& cell) const;
  bool inGrid(const cv::Point& cell) const;

  double cell_m_;
  Eigen::Vector2d origin_;
  cv::Mat clearance_;  ///< CV_32F, m
};

/// Free areas and obstacles of the whole draft.
FloorGrid floorGridOf(const FlatDraft& draft);

}  // namespace roomgraph
