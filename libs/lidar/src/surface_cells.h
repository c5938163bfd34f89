// SPDX-License-Identifier: BSD-3-Clause
// Surfaces of a submap finer than its cells: mean and scatter of the returns, apart by the side they are seen from.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "planar_scan.h"

namespace roomgraph {

/// Returns of a scan and the directions that their surfaces face, in the frame of the points.
struct FacedScan {
  Points2 points;
  std::vector<double> facing_rad;
};
/// Each return faces along the normal of the line through its neighbours, on the side of the lidar; towards the lidar where they form no
/// line.
FacedScan faced(const PlanarScan& scan);
FacedScan transformed(const Pose2& a_from_b, const FacedScan& in_b);

/// The returns around a place as a line.
struct SurfaceLine {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();  ///< m
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double variance_m2 = 0;  ///< of the returns across the line
  double turn_rad2 = 0;    ///< variance of its direction, as so few returns that scatter so much tell it
};

/// Mean and scatter of the returns in square cells, as the normal distributions transform keeps them (Biber and Strasser
/// 2003), here by the direction that the surface faces: the two sides of a wall in one cell stay two surfaces.
class SurfaceCells {
 public:
  explicit SurfaceCells(double cell_m) : cell_m_(cell_m) {}
  void insert(const FacedScan& scan);
  /// No scan comes any more: the cells in order, in half the memory. Lines stay what they are.
  void finish();
  /// The line through the returns in the 3 x 3 cells around a point that face about the same way (67 degrees at most); nothing
  /// where they are few or form no line.
  std::optional<SurfaceLine> around(const Eigen::Vector2d& point, double facing_rad) const;

  /// The cell of a point and about which way the surface there faces: all that a line depends on.
  struct Place {
    std::int32_t x = 0, y = 0;
    int sector = 0;
    bool operator==(const Place&) const = default;
  };
  static constexpr int kSectors = 8;
  /// Not where it is not finite or too far away: such a point has no place.
  static bool isReachable(const Eigen::Vector2d& point);
  static int sectorOf(double facing_rad);
  Place placeOf(const Eigen::Vector2d& point, int sector) const;
  std::optional<SurfaceLine> lineAt(const Place& place) const;

 private:
  struct Sums {
    float count = 0;
    Eigen::Vector2f first = Eigen::Vector2f::Zero();   // of the points, from the cell's corner
    Eigen::Vector3f second = Eigen::Vector3f::Zero();  // xx, xy, yy
  };
  static std::uint64_t key(std::int32_t ix, std::int32_t iy) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(ix)) << 32) | static_cast<std::uint32_t>(iy);
  }
  struct Facing {
    Sums sums;
    std::int32_t sector = 0, next = kNone;  // of the same cell
  };
  static constexpr std::int32_t kNone = -1;
  Sums& sumsOf(std::uint64_t cell, int sector);
  std::int32_t firstOf(std::uint64_t cell) const;

  double cell_m_;
  std::unordered_map<std::uint64_t, std::int32_t> first_of_cell_;  ///< until finished
  std::vector<std::uint64_t> cells_;                                ///< when finished, in ascending order
  std::vector<std::int32_t> firsts_;                                ///< of each of them
  std::vector<Facing> facings_;
  bool finished_ = false;
};

/// Surfaces at four sizes of cells; of those allowed, the finest that shows a line around a point is taken.
class LocalSurfaces {
 public:
  static constexpr int kUsual = 3, kAll = 4;  ///< the coarsest for lidars whose returns scatter by decimetres
  explicit LocalSurfaces(double cell_m)
      : levels_{SurfaceCells(cell_m), SurfaceCells(2 * cell_m), SurfaceCells(6 * cell_m), SurfaceCells(20 * cell_m)} {}
  void insert(const FacedScan& scan);
  void finish();
  std::optional<SurfaceLine> around(const Eigen::Vector2d& point, double facing_rad, int levels = kUsual) const;
  const SurfaceCells& level(int i) const { return levels_[static_cast<std::size_t>(i)]; }

 private:
  std::array<SurfaceCells, kAll> levels_;
};

/// Lines around the returns of a scan that is moved step by step: those of a return that stays in its cell are not sought again.
/// The surfaces must outlive it, and must not change.
class LinesOfReturns {
 public:
  LinesOfReturns(const LocalSurfaces& surfaces, std::size_t returns) : surfaces_(surfaces), found_(returns) {}
  /// That of LocalSurfaces::around() for the return of this number; null where there is none. Valid until the next call for it.
  const SurfaceLine* around(std::size_t number, const Eigen::Vector2d& point, double facing_rad, int levels);

 private:
  struct Found {
    std::optional<SurfaceCells::Place> place;
    std::optional<SurfaceLine> line;
  };
  const LocalSurfaces& surfaces_;
  std::vector<std::array<Found, LocalSurfaces::kAll>> found_;
};

}  // namespace roomgraph
