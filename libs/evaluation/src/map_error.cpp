// SPDX-License-Identifier: BSD-3-Clause
// Cell states compared at cell centres, and wall distances by nearest neighbour.
#include "roomgraph/evaluation/map_error.h"

#include <algorithm>
#include <cmath>

#include "nearest_point.h"

namespace roomgraph {
namespace {

enum class State { kUnknown, kFree, kOccupied };

struct Cell {
  Eigen::Vector2d place;                                  // centre in the truth's world, m
  State here = State::kUnknown, there = State::kUnknown;  // in its own and in the other map
};

class Grid {
 public:
  Grid(const mrpt::maps::COccupancyGridMap2D& cells, const MapOptions& options)
      : cells_(cells), options_(options), resolution_(static_cast<double>(cells.getResolution())) {}

  int width() const { return static_cast<int>(cells_.getSizeX()); }
  int height() const { return static_cast<int>(cells_.getSizeY()); }
  Eigen::Vector2d center(int x, int y) const {
    return {static_cast<double>(cells_.getXMin()) + (x + 0.5) * resolution_,
            static_cast<double>(cells_.getYMin()) + (y + 0.5) * resolution_};
  }
  State at(int x, int y) const {
    if (x < 0 || y < 0 || x >= width() || y >= height()) return State::kUnknown;
    const double occupied = 1 - static_cast<double>(cells_.getCell(x, y));
    if (occupied > options_.occupied_above) return State::kOccupied;
    return occupied < options_.free_below ? State::kFree : State::kUnknown;
  }
  State at(const Eigen::Vector2d& place) const {
    return at(
        static_cast<int>(std::floor((place.x() - static_cast<double>(cells_.getXMin())) / resolution_)),
        static_cast<int>(std::floor((place.y() - static_cast<double>(cells_.getYMin())) / resolution_)));
  }

 private:
  const mrpt::maps::COccupancyGridMap2D& cells_;
  const MapOptions& options_;
  double resolution_;
};

// The known cells of `grid`, with the state of `other` at the same places.
std::vector<Cell> knownCells(const Grid& grid, const Pose2& truth_from_grid, const Grid& other,
                             const Pose2& other_from_grid) {
  std::vector<Cell> out;
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      const State here = grid.at(x, y);
      if (here == State::kUnknown) continue;
      const Eigen::Vector2d center = grid.center(x, y);
      out.push_back({truth_from_grid * center, here, other.at(other_from_grid * center)});
    }
  return out;
}

int count(const std::vector<Cell>& cells, State here, State there) {
  return static_cast<int>(std::count_if(cells.begin(), cells.end(),
                                        [&](const Cell& c) { return c.here == here && c.there == there; }));
}

std::vector<Eigen::Vector2d> occupiedPlaces(const std::vector<Cell>& cells) {
  std::vector<Eigen::Vector2d> places;
  for (const auto& cell : cells)
    if (cell.here == State::kOccupied) places.push_back(cell.place);
  return places;
}

struct Walls {
  int all = 0, checked = 0, near = 0;  // checked: known in the other map, too
  ErrorStatistics distance_m;
};

Walls compareWalls(const std::vector<Cell>& cells, const NearestPoint& other, double tolerance_m) {
  Walls out;
  std::vector<double> distances;
  for (const auto& cell : cells) {
    if (cell.here != State::kOccupied) continue;
    const double distance = other.distance(cell.place);
    ++out.all;
    if (std::isfinite(distance)) distances.push_back(distance);
    if (cell.there == State::kUnknown) continue;
    ++out.checked;
    out.near += distance < tolerance_m;
  }
  out.distance_m = summarize(std::move(distances));
  return out;
}

double ratio(double part, double whole) {
  return whole > 0 ? part / whole : 0;
}

void setAgreement(const std::vector<Cell>& map, const std::vector<Cell>& truth, MapErrors& out) {
  const int both_free = count(map, State::kFree, State::kFree);
  const int both_occupied = count(map, State::kOccupied, State::kOccupied);
  const int only_map_free = count(map, State::kFree, State::kOccupied);
  const int only_truth_free = count(map, State::kOccupied, State::kFree);
  out.known_in_both = both_free + both_occupied + only_map_free + only_truth_free;
  out.agreement = ratio(both_free + both_occupied, out.known_in_both);
  out.free_precision = ratio(both_free, both_free + only_map_free);
  out.free_agreement = ratio(both_free, both_free + only_truth_free);
  out.unknown_share =
      ratio(count(truth, State::kFree, State::kUnknown) + count(truth, State::kOccupied, State::kUnknown),
            static_cast<double>(truth.size()));
}

}  // namespace

MapErrors evaluateMap(const mrpt::maps::COccupancyGridMap2D& truth,
                      const mrpt::maps::COccupancyGridMap2D& map, const MapOptions& options) {
  const Grid truth_grid(truth, options), map_grid(map, options);
  const auto map_cells = knownCells(map_grid, options.truth_from_map, truth_grid, options.truth_from_map);
  const auto true_cells = knownCells(truth_grid, {}, map_grid, options.truth_from_map.inverse());
  const double cell_m = static_cast<double>(std::max(truth.getResolution(), map.getResolution()));
  const double tolerance_m = (options.tolerance_cells + 0.5) * cell_m;
  const Walls walls = compareWalls(map_cells, NearestPoint(occupiedPlaces(true_cells)), tolerance_m);
  const Walls true_walls = compareWalls(true_cells, NearestPoint(occupiedPlaces(map_cells)), tolerance_m);

  MapErrors out;
  out.estimated_occupied = walls.all;
  out.true_occupied = true_walls.all;
  out.checked_occupied = walls.checked;
  out.correct_occupied = walls.near;
  out.expected_occupied = true_walls.checked;
  out.found_occupied = true_walls.near;
  out.precision = ratio(walls.near, walls.checked);
  out.recall = ratio(true_walls.near, true_walls.checked);
  out.f1 = ratio(2 * out.precision * out.recall, out.precision + out.recall);
  out.to_truth_m = walls.distance_m;
  out.to_map_m = true_walls.distance_m;
  setAgreement(map_cells, true_cells, out);
  return out;
}

}  // namespace roomgraph
