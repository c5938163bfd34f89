// SPDX-License-Identifier: BSD-3-Clause
// Depth-first branch and bound over shifts and angles on a score pyramid.
#include "correlative_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace roomgraph {
namespace {

using Cell = ScorePyramid::Cell;

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
        best_score_(window.min_score),
        count_(points.size()) {
    reach_ = static_cast<int>(std::ceil(window.linear_m / pyramid.cellSize() - 1e-9));
    chooseAngles(points);
    rotated_.reserve(static_cast<std::size_t>(2 * angles_ + 1) * count_);
    for (int a = -angles_; a <= angles_; ++a) addCellsAt(points, a * angle_step_);
    takeTheMiddle();
  }

  std::optional<SearchResult> run() {
    int level = 0;
    while (level + 1 < pyramid_.levels() && (1 << level) < 2 * reach_ + 1) ++level;
    std::vector<Candidate> roots;
    for (int a = -angles_; a <= angles_; ++a)
      for (int x = -reach_; x <= reach_; x += 1 << level)
        for (int y = -reach_; y <= reach_; y += 1 << level)
          roots.push_back(bounded(level, {a, x, y, 0}, pyramid_.sum(level, cellsAt(a), {x, y})));
    std::stable_sort(roots.begin(), roots.end(), isBetter);
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

  // Whatever is worse than the start need not be looked at; what is as good is found in the order of the search.
  void takeTheMiddle() {
    constexpr double kAsGood = 1e-9;
    const Candidate middle = bounded(0, {0, 0, 0, 0}, pyramid_.sum(0, cellsAt(0), {0, 0}));
    if (!isExcluded(middle)) best_score_ = std::max(best_score_, middle.bound - kAsGood);
  }

  void addCellsAt(const Points2& points, double turn) {
    const PointsMovement from_corner({start_.x - pyramid_.corner().x(), start_.y - pyramid_.corner().y(), start_.yaw + turn});
    for (const Eigen::Vector2d& point : points) {
      const Eigen::Vector2d p = from_corner * point;
      rotated_.push_back({static_cast<int>(std::floor(p.x() / pyramid_.cellSize())),
                          static_cast<int>(std::floor(p.y() / pyramid_.cellSize()))});
    }
  }
  std::span<const Cell> cellsAt(int angle) const {
    return std::span(rotated_).subspan(static_cast<std::size_t>(angle + angles_) * count_, count_);
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

  // `sum`: of the level at its cells.
  Candidate bounded(int level, Candidate c, int sum) const {
    // Smallest shift inside the square: the penalty, too, must be a bound.
    const int last = (1 << level) - 1;
    const double dx = pyramid_.cellSize() * std::max({0, c.x, -(c.x + last)});
    const double dy = pyramid_.cellSize() * std::max({0, c.y, -(c.y + last)});
    const double turn = c.angle * angle_step_;
    c.bound = sum / (255.0 * static_cast<double>(count_)) - window_.penalty_per_m2 * (dx * dx + dy * dy) -
              window_.penalty_per_rad2 * turn * turn;
    return c;
  }

  static bool isBetter(const Candidate& a, const Candidate& b) { return a.bound > b.bound; }

  struct Quarters {
    std::array<Candidate, 4> candidates{};
    std::size_t count = 0;
  };

  // Of a candidate's square, the best first; they are few and made often, so that they are sorted as they come.
  Quarters quartersOf(const Candidate& c, int level) const {
    Quarters out;
    const int half = 1 << (level - 1);
    const auto sums = pyramid_.sumsAtCorners(level - 1, cellsAt(c.angle), {c.x, c.y}, half);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const Candidate corner{c.angle, c.x + (i < 2 ? 0 : half), c.y + (i % 2 == 0 ? 0 : half), 0};
      if (corner.x > reach_ || corner.y > reach_) continue;
      const Candidate quarter = bounded(level - 1, corner, sums[i]);
      std::size_t at = out.count++;
      for (; at > 0 && isBetter(quarter, out.candidates[at - 1]); --at) out.candidates[at] = out.candidates[at - 1];
      out.candidates[at] = quarter;
    }
    return out;
  }

  // The best comes first.
  void visit(std::span<const Candidate> candidates, int level) {
    for (const Candidate& c : candidates) {
      if (c.bound <= best_score_) return;
      if (level == 0) {
        if (isExcluded(c)) continue;
        best_ = c;
        best_score_ = c.bound;
        found_ = true;
        return;
      }
      const Quarters quarters = quartersOf(c, level);
      visit({quarters.candidates.data(), quarters.count}, level - 1);
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
  std::size_t count_;          // of the points
  std::vector<Cell> rotated_;  // at one angle after another
};

}  // namespace

std::optional<SearchResult> correlativeSearch(const ScorePyramid& pyramid, const Points2& points,
                                              const Pose2& grid_from_scan, const SearchWindow& window,
                                              const std::optional<ExcludedPose>& excluded) {
  if (points.empty() || pyramid.levels() == 0) return std::nullopt;
  return BranchAndBound(pyramid, points, grid_from_scan, window, excluded).run();
}

}  // namespace roomgraph
