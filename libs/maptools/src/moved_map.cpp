// SPDX-License-Identifier: BSD-3-Clause
// A map in another frame: objects, poses, and cells by the nearest one.
#include "region.h"
#include "roomgraph/geometry/covariance.h"
#include "roomgraph/maptools/map_alignment.h"

namespace roomgraph {
namespace {

using mrpt::maps::COccupancyGridMap2D;

// A lattice of the cell size that has a corner at `anchor`.
struct Lattice {
  double cell_m;
  Eigen::Vector2d anchor;
  double below(double along, int axis) const {
    return anchor[axis] + std::floor((along - anchor[axis]) / cell_m + 1e-6) * cell_m;
  }
};

COccupancyGridMap2D::Ptr resampled(const COccupancyGridMap2D& grid, const Pose2& a_from_b,
                                   const Lattice& lattice) {
  const Eigen::Vector2d low(static_cast<double>(grid.getXMin()), static_cast<double>(grid.getYMin()));
  const Eigen::Vector2d high(static_cast<double>(grid.getXMax()), static_cast<double>(grid.getYMax()));
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner :
       {low, high, Eigen::Vector2d(low.x(), high.y()), Eigen::Vector2d(high.x(), low.y())})
    box.extend(a_from_b * corner);
  auto out = COccupancyGridMap2D::Create();
  out->setSize(static_cast<float>(lattice.below(box.min().x(), 0)),
               static_cast<float>(lattice.below(box.max().x(), 0) + lattice.cell_m),
               static_cast<float>(lattice.below(box.min().y(), 1)),
               static_cast<float>(lattice.below(box.max().y(), 1) + lattice.cell_m),
               static_cast<float>(lattice.cell_m));
  out->fill(0.5f);
  const Pose2 b_from_a = a_from_b.inverse();
  for (int y = 0; y < static_cast<int>(out->getSizeY()); ++y)
    for (int x = 0; x < static_cast<int>(out->getSizeX()); ++x) {
      const Eigen::Vector2d at = b_from_a * cellCentre(*out, x, y);
      const int i = grid.x2idx(at.x()), j = grid.y2idx(at.y());
      if (i >= 0 && j >= 0 && i < static_cast<int>(grid.getSizeX()) && j < static_cast<int>(grid.getSizeY()))
        out->getRow(y)[x] = grid.getRow(j)[i];
    }
  return out;
}

Landmark moved(Landmark landmark, const MapAlignment& alignment) {
  const Pose2& pose = alignment.a_from_b;
  const Eigen::Vector2d at = pose * Eigen::Vector2d(landmark.position.head<2>());
  // A turn of the map about its origin moves the place, too.
  Eigen::Matrix<double, 4, 3> by_transform = Eigen::Matrix<double, 4, 3>::Zero();
  by_transform(0, 0) = by_transform(1, 1) = by_transform(3, 2) = 1;
  by_transform(0, 2) = -(at.y() - pose.y);
  by_transform(1, 2) = at.x() - pose.x;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(pose.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  landmark.covariance = rotateCovariance(landmark.covariance, turn) +
                        by_transform * alignment.covariance * by_transform.transpose();
  landmark.position.head<2>() = at;
  landmark.yaw = wrapAngle(landmark.yaw + pose.yaw);
  return landmark;
}

}  // namespace

CSemanticMap movedMap(const CSemanticMap& b, const MapAlignment& alignment,
                      const COccupancyGridMap2D* lattice) {
  CSemanticMap out = b;
  for (auto& landmark : out.landmarks) landmark = moved(landmark, alignment);
  for (auto& stamped : out.world_from_robot) stamped.pose = toPose3(alignment.a_from_b) * stamped.pose;
  for (auto& view : out.views) view.world_from_camera = toPose3(alignment.a_from_b) * view.world_from_camera;
  if (!b.occupancy) return out;
  const auto& model = lattice ? *lattice : *b.occupancy;
  const Lattice target{
      static_cast<double>(model.getResolution()),
      lattice ? Eigen::Vector2d(static_cast<double>(model.getXMin()), static_cast<double>(model.getYMin()))
              : Eigen::Vector2d::Zero()};
  out.occupancy = resampled(*b.occupancy, alignment.a_from_b, target);
  return out;
}

}  // namespace roomgraph
