// SPDX-License-Identifier: BSD-3-Clause
// Prediction of boxes between views, and the chain problem of an object.
#include "object_chain.h"

#include <algorithm>
#include <array>

namespace roomgraph {
namespace {

// The affine map per axis from the area `from` to `to`, applied to `box`. A side cut by the image border is not a side
// of the object: the side of `to` takes its place.
Box2 movedAlong(const Box2& box, const ProjectedShape& from, const Box2& to) {
  const Box2& full = from.full;
  const double su = to.width() / full.width(), sv = to.height() / full.height();
  return {from.cut.left ? to.u_min : to.u_min + su * (box.u_min - full.u_min),
          from.cut.top ? to.v_min : to.v_min + sv * (box.v_min - full.v_min),
          from.cut.right ? to.u_max : to.u_min + su * (box.u_max - full.u_min),
          from.cut.bottom ? to.v_max : to.v_min + sv * (box.v_max - full.v_min)};
}

// Bounds of the box's corners under the camera's rotation alone, as if the object were at infinity.
std::optional<Box2> boxUnderRotation(const Sighting& sighting, const Viewpoint& view) {
  const Eigen::Matrix3d now_from_before =
      view.world_from_camera.linear().transpose() * sighting.view.world_from_camera.linear();
  const Box2& b = sighting.box;
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  for (const auto& [u, v] : std::array<std::array<double, 2>, 4>{
           {{b.u_min, b.v_min}, {b.u_max, b.v_min}, {b.u_min, b.v_max}, {b.u_max, b.v_max}}}) {
    const Eigen::Vector3d ray = now_from_before * sighting.view.camera.ray(u, v);
    if (ray.z() < 0.1) return std::nullopt;
    low = low.cwiseMin(view.camera.project(ray));
    high = high.cwiseMax(view.camera.project(ray));
  }
  return Box2{low.x(), low.y(), high.x(), high.y()};
}

}  // namespace

Sighting makeSighting(const Detection& detection, const std::vector<const Proposal*>& proposals,
                      const Viewpoint& view, const std::vector<FeatureTrack>& features) {
  Sighting out{0, detection.box, view};
  out.unary.push_back(0);
  for (const Proposal* proposal : proposals) {
    out.shapes.push_back(shapeInWorld(*proposal, view.world_from_camera));
    out.unary.push_back(unaryEnergy(*proposal, detection));
  }
  out.features = featuresInside(features, detection.box);
  return out;
}

Eigen::MatrixXd pairwiseEnergies(const Sighting& before, const Sighting& now, double weight) {
  const auto rows = static_cast<Eigen::Index>(before.unary.size());
  const auto columns = static_cast<Eigen::Index>(now.unary.size());
  Eigen::MatrixXd energies = Eigen::MatrixXd::Zero(rows, columns);
  if (weight <= 0 || columns == 1) return energies;
  for (Eigen::Index x = 1; x < rows; ++x) {
    const auto carried = carriedArea(before.shapes[static_cast<std::size_t>(x - 1)], now.view);
    energies(x, 0) = weight;
    for (Eigen::Index y = 1; y < columns; ++y) {
      const auto& shape = now.shapes[static_cast<std::size_t>(y - 1)].projected;
      energies(x, y) = weight * pairwisePotential(areaInImage(shape, now.view.camera), carried);
    }
  }
  return energies;
}

std::optional<Box2> predictedBox(const Sighting& sighting, const Viewpoint& view) {
  std::optional<Box2> box;
  if (sighting.shapes.empty()) {
    box = boxUnderRotation(sighting, view);
  } else {
    const auto best = std::min_element(sighting.unary.begin() + 1, sighting.unary.end());
    const auto& shape = sighting.shapes[static_cast<std::size_t>(best - sighting.unary.begin() - 1)];
    if (const auto area = carriedArea(shape, view))
      box = shape.projected.full.empty() ? area->full : movedAlong(sighting.box, shape.projected, area->full);
  }
  if (!box) return std::nullopt;
  const Box2 visible = clipped(*box, view.camera.width, view.camera.height);
  if (visible.empty()) return std::nullopt;
  return visible;
}

ChainProblem chainProblem(const ObjectChain& chain, bool must_appear, double none) {
  ChainProblem problem;
  problem.must_appear = must_appear;
  for (const auto& sighting : chain.sightings) {
    if (!problem.unary.empty()) problem.pairwise.push_back(sighting.pairwise);
    problem.unary.push_back(sighting.unary);
    problem.unary.back()[0] = none;
  }
  return problem;
}

}  // namespace roomgraph
