// SPDX-License-Identifier: BSD-3-Clause
// k-d tree (nanoflann) over planar points.
#include "nearest_point.h"

#include <cmath>
#include <limits>
#include <nanoflann.hpp>

namespace roomgraph {

struct NearestPoint::Index {
  struct Points {
    std::vector<Eigen::Vector2d> list;
    // Names that nanoflann requires.
    std::size_t kdtree_get_point_count() const { return list.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const { return list[i][static_cast<Eigen::Index>(axis)]; }
    template <class Bounds>
    bool kdtree_get_bbox(Bounds&) const {
      return false;
    }
  };

  explicit Index(std::vector<Eigen::Vector2d> list) : points{std::move(list)}, tree(2, points) {}

  Points points;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 2> tree;
};

NearestPoint::NearestPoint(std::vector<Eigen::Vector2d> points)
    : index_(points.empty() ? nullptr : std::make_unique<Index>(std::move(points))) {}
NearestPoint::~NearestPoint() = default;

double NearestPoint::distance(const Eigen::Vector2d& from) const {
  if (!index_) return std::numeric_limits<double>::infinity();
  std::size_t nearest = 0;
  double squared = 0;
  nanoflann::KNNResultSet<double> result(1);
  result.init(&nearest, &squared);
  index_->tree.findNeighbors(result, from.data(), nanoflann::SearchParams());
  return std::sqrt(squared);
}

}  // namespace roomgraph
