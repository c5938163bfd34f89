// SPDX-License-Identifier: BSD-3-Clause
// Depth-first branch and bound over shifts and angles on a score pyramid.
#include "correlative_search.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

struct Cell {
  int x, y;
};

/// A square of 2^level shifts, in cells, at one angle.
struct Candidate {
  int angle, x, y;
  double bound;
};

class BranchAndBound {
 public:
  BranchAndBound(const ScorePyramid& pyramid, const Points2& points, const Pose2& start,
                 const SearchWindow& window, const std::optional<ExcludedPose>& excluded)
      : pyramid_(pyramid),
        start_(start),
        window_(window),
        excluded_(excluded),
        best_score_(window.min_score) {
    reach_ = static_cast<int>(std::ceil(window.linear_m / pyramid.cellSize() - 1e-9));
    chooseAngles(points);
    for (int a = -angles_; a <= angles_; ++a) rotated_.push_back(cellsAt(points, a * angle_step_));
  }

  std::optional<SearchResult> run() {
    int level = 0;
    while (level + 1 < pyramid_.levels() && (1 << level) < 2 * reach_ + 1) ++level;
    std::vector<Candidate> roots;
    for (int a = -angles_; a <= angles_; ++a)
      for (int x = -reach_; x <= reach_; x += 1 << level)
        for (int y = -reach_; y <= reach_; y += 1 << level) roots.push_back(bounded(level, {a, x, y, 0}));
    visit(roots, level);
    if (!found_) return std::nullopt;
    return SearchResult{poseOf(best_), best_score_};
  }

 private:
  void chooseAngles(const Points2& points) {
    double farthest = 1;
    for (const Eigen::Vector2d& p : points) farthest = std::max(farthest, p.norm());
    angle_step_ = pyramid_.cellSize() / farthest;
    angles_ = static_cast<int>(std::ceil(window_.angular_rad / angle_step_ - 1e-9));
    if (angles_ > 0) angle_step_ = window_.angular_rad / angles_;
  }

  std::vector<Cell> cellsAt(const Points2& points, double turn) const {
    const Pose2 pose{start_.x - pyramid_.corner().x(), start_.y - pyramid_.corner().y(), start_.yaw + turn};
    std::vector<Cell> cells;
    cells.reserve(points.size());
    for (const Eigen::Vector2d& p : transformed(pose, points))
      cells.push_back({static_cast<int>(std::floor(p.x() / pyramid_.cellSize())),
                       static_cast<int>(std::floor(p.y() / pyramid_.cellSize()))});
    return cells;
  }

  Pose2 poseOf(const Candidate& c) const {
    const double cell = pyramid_.cellSize();
    return {start_.x + c.x * cell, start_.y + c.y * cell, wrapAngle(start_.yaw + c.angle * angle_step_)};
  }

  bool isExcluded(const Candidate& c) const {
    if (!excluded_) return false;
    const Pose2 p = poseOf(c);
    return std::hypot(p.x - excluded_->pose.x, p.y - excluded_->pose.y) < excluded_->radius_m &&
           std::abs(wrapAngle(p.yaw - excluded_->pose.yaw)) < excluded_->radius_rad;
  }

  Candidate bounded(int level, Candidate c) const {
    const std::vector<Cell>& cells = rotated_[static_cast<std::size_t>(c.angle + angles_)];
    int sum = 0;
    for (const Cell& cell : cells) sum += pyramid_.at(level, cell.x + c.x, cell.y + c.y);
    // Smallest shift inside the square: the penalty, too, must be a bound.
    const int last = (1 << level) - 1;
    const double dx = pyramid_.cellSize() * std::max({0, c.x, -(c.x + last)});
    const double dy = pyramid_.cellSize() * std::max({0, c.y, -(c.y + last)});
    const double turn = c.angle * angle_step_;
    c.bound = sum / (255.0 * static_cast<double>(cells.size())) -
              window_.penalty_per_m2 * (dx * dx + dy * dy) - window_.penalty_per_rad2 * turn * turn;
    return c;
  }

  void visit(std::vector<Candidate>& candidates, int level) {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.bound > b.bound; });
    for (const Candidate& c : candidates) {
      if (c.bound <= best_score_) return;
      if (level == 0) {
        if (isExcluded(c)) continue;
        best_ = c;
        best_score_ = c.bound;
        found_ = true;
        return;
      }
      const int half = 1 << (level - 1);
      std::vector<Candidate> children;
      for (int x : {c.x, c.x + half})
        for (int y : {c.y, c.y + half})
          if (x <= reach_ && y <= reach_) children.push_back(bounded(level - 1, {c.angle, x, y, 0}));
      visit(children, level - 1);
    }
  }

  const ScorePyramid& pyramid_;
  const Pose2 start_;
  const SearchWindow& window_;
  const std::optional<ExcludedPose>& excluded_;
  double angle_step_ = 0, best_score_;
  int reach_ = 0, angles_ = 0;
  bool found_ = false;
  Candidate best_{};
  std::vector<std::vector<Cell>> rotated_;
};

}  // namespace

std::optional<SearchResult> correlativeSearch(const ScorePyramid& pyramid, const Points2& points,
                                              const Pose2& grid_from_scan, const SearchWindow& window,
                                              const std::optional<ExcludedPose>& excluded) {
  if (points.empty() || pyramid.levels() == 0) return std::nullopt;
  return BranchAndBound(pyramid, points, grid_from_scan, window, excluded).run();
}

}  // namespace roomgraph
