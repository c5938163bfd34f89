// SPDX-License-Identifier: BSD-3-Clause
// True occupancy map from the outlines at lidar height, as PGM and YAML.
#include <cmath>
#include <queue>

#include "truth_files.h"

namespace roomgraph {
namespace {

constexpr double kTruthCell_m = 0.05;
constexpr uchar kOccupied = 0, kFree = 254, kUnknown = 205;

struct TruthGrid {
  Eigen::Vector2d origin;  ///< lower left corner, m
  cv::Mat cells;           ///< row 0 at the lowest y
  cv::Point cellOf(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d cell = (p - origin) / kTruthCell_m;
    return {static_cast<int>(std::floor(cell.x())), static_cast<int>(std::floor(cell.y()))};
  }
};

TruthGrid gridAround(const std::vector<Segment>& outlines) {
  Eigen::AlignedBox2d box(Eigen::Vector2d::Zero());
  for (const auto& segment : outlines) box.extend(segment.a).extend(segment.b);
  TruthGrid grid;
  grid.origin = (box.min().array() - 0.5).unaryExpr([](double x) { return std::floor(x); });
  const Eigen::Vector2d size = (box.max() - grid.origin).array() + 0.5;
  grid.cells = cv::Mat(static_cast<int>(std::ceil(size.y() / kTruthCell_m)),
                       static_cast<int>(std::ceil(size.x() / kTruthCell_m)), CV_8U, cv::Scalar(kUnknown));
  return grid;
}

/// Marks every cell that can be reached from the robot's start without crossing an outline.
void fill(TruthGrid& grid) {
  std::queue<cv::Point> open;
  open.push(grid.cellOf({0, 0}));
  const cv::Rect area(0, 0, grid.cells.cols, grid.cells.rows);
  while (!open.empty()) {
    const cv::Point cell = open.front();
    open.pop();
    if (!area.contains(cell) || grid.cells.at<uchar>(cell) != kUnknown) continue;
    grid.cells.at<uchar>(cell) = kFree;
    for (const auto& step : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)})
      open.push(cell + step);
  }
}

}  // namespace

void writeMapTruth(const std::filesystem::path& pgm, const std::filesystem::path& yaml,
                   const std::vector<Segment>& outlines) {
  TruthGrid grid = gridAround(outlines);
  for (const auto& segment : outlines) {
    const int steps = 1 + static_cast<int>((segment.b - segment.a).norm() / (kTruthCell_m / 10));
    for (int i = 0; i <= steps; ++i)
      grid.cells.at<uchar>(grid.cellOf(segment.a + (segment.b - segment.a) * i / steps)) = kOccupied;
  }
  fill(grid);
  TruthFile picture(pgm);
  picture << "P5\n" << grid.cells.cols << " " << grid.cells.rows << "\n255\n";
  for (int row = grid.cells.rows - 1; row >= 0; --row)
    picture.write(reinterpret_cast<const char*>(grid.cells.ptr(row)), grid.cells.cols);
  picture.finish();
  TruthFile text(yaml);
  text.line(
      "image: map_truth.pgm\nresolution: %.3f\norigin: [%.3f, %.3f, 0.0]\nnegate: 0\noccupied_thresh: "
      "0.65\nfree_thresh: 0.196",
      kTruthCell_m, grid.origin.x(), grid.origin.y());
  text.finish();
}

}  // namespace roomgraph
