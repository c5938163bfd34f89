// SPDX-License-Identifier: BSD-3-Clause
// Distance transform, flood fill and A* on the floor of a flat.
#include "flat_grid.h"

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <queue>

namespace roomgraph {
namespace {

const std::vector<std::pair<cv::Point, double>> kSteps{
    {{1, 0}, 1}, {{-1, 0}, 1}, {{0, 1}, 1}, {{0, -1}, 1},
    {{1, 1}, std::numbers::sqrt2}, {{1, -1}, std::numbers::sqrt2}, {{-1, 1}, std::numbers::sqrt2},
    {{-1, -1}, std::numbers::sqrt2}};

bool contains(const Polygon& polygon, const Eigen::Vector2d& p) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d d = polygon[(i + 1) % polygon.size()] - polygon[i], q = p - polygon[i];
    if (d.x() * q.y() - d.y() * q.x() < 0) return false;
  }
  return true;
}

PlanBox boundsOf(const Polygon& polygon) {
  PlanBox out;
  for (const auto& corner : polygon) out.extend(corner);
  return out;
}

}  // namespace

FloorGrid::FloorGrid(const std::vector<PlanBox>& free, const std::vector<Polygon>& obstacles, double cell_m)
    : cell_m_(cell_m) {
  PlanBox bounds;
  for (const auto& box : free) bounds.extend(box);
  origin_ = bounds.min().array() - 2 * cell_m;
  const Eigen::Vector2d size = (bounds.sizes().array() + 4 * cell_m) / cell_m;
  cv::Mat mask(static_cast<int>(std::ceil(size.y())), static_cast<int>(std::ceil(size.x())), CV_8U, cv::Scalar(0));
  const auto fill = [&](const PlanBox& area, uchar value, auto&& inside) {
    const cv::Point low = cellOf(area.min()), high = cellOf(area.max());
    for (int y = std::max(0, low.y); y <= std::min(high.y, mask.rows - 1); ++y)
      for (int x = std::max(0, low.x); x <= std::min(high.x, mask.cols - 1); ++x)
        if (inside(centre({x, y}))) mask.at<uchar>(y, x) = value;
  };
  for (const auto& box : free) fill(box, 255, [&](const auto& p) { return box.contains(p); });
  for (const auto& polygon : obstacles)
    fill(boundsOf(polygon), 0, [&](const auto& p) { return contains(polygon, p); });
  cv::distanceTransform(mask, clearance_, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  // From centre to centre; the border lies half a cell nearer.
  clearance_ = cv::max((clearance_ - 0.5) * cell_m, 0);
}

cv::Point FloorGrid::cellOf(const Eigen::Vector2d& at) const {
  const Eigen::Vector2d cell = (at - origin_) / cell_m_;
  return {static_cast<int>(std::floor(cell.x())), static_cast<int>(std::floor(cell.y()))};
}

Eigen::Vector2d FloorGrid::centre(const cv::Point& cell) const {
  return origin_ + cell_m_ * Eigen::Vector2d(cell.x + 0.5, cell.y + 0.5);
}

bool FloorGrid::inGrid(const cv::Point& cell) const {
  return cell.x >= 0 && cell.y >= 0 && cell.x < clearance_.cols && cell.y < clearance_.rows;
}

double FloorGrid::clearance(const Eigen::Vector2d& at) const {
  const cv::Point cell = cellOf(at);
  return inGrid(cell) ? clearance_.at<float>(cell) : 0;
}

std::vector<Eigen::Vector2d> FloorGrid::reachable(const Eigen::Vector2d& from, double clearance) const {
  std::vector<Eigen::Vector2d> out;
  cv::Mat seen(clearance_.size(), CV_8U, cv::Scalar(0));
  std::queue<cv::Point> open;
  const auto visit = [&](const cv::Point& cell) {
    if (!inGrid(cell) || seen.at<uchar>(cell) || clearance_.at<float>(cell) < clearance) return;
    seen.at<uchar>(cell) = 1;
    open.push(cell);
    out.push_back(centre(cell));
  };
  visit(cellOf(from));
  while (!open.empty()) {
    const cv::Point cell = open.front();
    open.pop();
    for (std::size_t i = 0; i < 4; ++i) visit(cell + kSteps[i].first);
  }
  return out;
}

std::vector<Eigen::Vector2d> FloorGrid::way(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                            double clearance) const {
  constexpr double kComfort_m = 0.5, kNarrow = 3;  // beside obstacles a step costs up to 1 + kNarrow as much
  constexpr double kGreed = 1.4;  // fewer cells are looked at; a way costs at most that many times the least
  const cv::Point start = cellOf(from), goal = cellOf(to);
  if (!inGrid(start) || !inGrid(goal)) return {};
  cv::Mat cost(clearance_.size(), CV_64F, cv::Scalar(std::numeric_limits<double>::infinity()));
  cv::Mat before(clearance_.size(), CV_32S, cv::Scalar(-1));
  using Entry = std::pair<double, int>;  // estimated cost of the whole way, cell's number: ties are always broken alike
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto number = [&](const cv::Point& cell) { return cell.y * clearance_.cols + cell.x; };
  const auto to_goal = [&](const cv::Point& cell) { return kGreed * std::hypot(cell.x - goal.x, cell.y - goal.y); };
  cv::Mat closed(clearance_.size(), CV_8U, cv::Scalar(0));
  cost.at<double>(start) = 0;
  open.push({to_goal(start), number(start)});
  while (!open.empty()) {
    const int index = open.top().second;
    open.pop();
    const cv::Point cell(index % clearance_.cols, index / clearance_.cols);
    if (cell == goal) break;
    if (closed.at<uchar>(cell)) continue;
    closed.at<uchar>(cell) = 1;
    for (const auto& [step, length] : kSteps) {
      const cv::Point next = cell + step;
      if (!inGrid(next) || clearance_.at<float>(next) < clearance) continue;
      const double narrow = std::max(0.0, 1 - (clearance_.at<float>(next) - clearance) / kComfort_m);
      const double total = cost.at<double>(cell) + length * (1 + kNarrow * narrow);
      if (total >= cost.at<double>(next)) continue;
      cost.at<double>(next) = total;
      before.at<int>(next) = index;
      open.push({total + to_goal(next), number(next)});
    }
  }
  if (!(cost.at<double>(goal) < std::numeric_limits<double>::infinity())) return {};
  std::vector<Eigen::Vector2d> out{to};
  for (int index = before.at<int>(goal); index >= 0;) {
    const cv::Point cell(index % clearance_.cols, index / clearance_.cols);
    index = before.at<int>(cell);
    out.push_back(index < 0 ? from : centre(cell));
  }
  return {out.rbegin(), out.rend()};
}

FloorGrid floorGridOf(const FlatDraft& draft) {
  std::vector<Polygon> obstacles = draft.obstacles;
  for (const auto& item : draft.world.furniture)
    if (item.at_m.z() < 1.5) {
      // World files are checked with the rectangle of round things, too.
      Furniture square = item;
      square.model = "block";
      obstacles.push_back(floorPolygon(square));
    }
  for (const auto& room : draft.world.rooms)
    for (const auto& doorway : room.doorways)
      if (!passable(doorway)) obstacles.push_back(boxPolygon(doorwayHole(draft.world, room, doorway)));
  return FloorGrid(freeAreas(draft.world), obstacles);
}

}  // namespace roomgraph
