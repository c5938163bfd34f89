// SPDX-License-Identifier: BSD-3-Clause
// Agreement of projected shape and box, overlap of carried areas, share of common features.
#include "potentials.h"

#include <algorithm>
#include <iterator>

namespace roomgraph {
namespace {

template <class Keep>
std::vector<std::int64_t> idsOf(const std::vector<FeatureTrack>& features, const Keep& keep) {
  std::vector<std::int64_t> ids;
  for (const auto& feature : features)
    if (feature.point >= 0 && keep(feature)) ids.push_back(feature.point);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

}  // namespace

double unaryPotential(const Proposal& proposal, const Detection& detection) {
  if (detection.box.diagonal() <= 0) return 0;
  const double apart = (proposal.projected.visible.center() - detection.box.center()).norm();
  const double d = std::min(1.0, apart / detection.box.diagonal());
  return -proposal.box_iou * (1 - d);
}

double unaryEnergy(const Proposal& proposal, const Detection& detection) {
  return detection.score * unaryPotential(proposal, detection) * (0.5 + 0.5 * proposal.score);
}

ShapeInWorld shapeInWorld(const Proposal& proposal, const Pose3& world_from_camera) {
  return {proposal.shape, world_from_camera * proposal.camera_from_object, proposal.projected};
}

std::optional<ProjectedShape> carriedArea(const ShapeInWorld& shape, const Viewpoint& view) {
  auto area = projectShape(shape.shape, view.world_from_camera.inverse() * shape.world_from_object, view.camera);
  // Cut as areaInImage() cuts the area it is compared with.
  if (area) area->visible = areaInImage(*area, view.camera);
  return area;
}

Box2 areaInImage(const ProjectedShape& projected, const PinholeCamera& camera) {
  return clipped(projected.full, camera.width, camera.height);
}

double pairwisePotential(const Box2& area, const std::optional<ProjectedShape>& carried) {
  return carried ? 1 - iou(area, carried->visible) : 1;
}

double featureShare(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b) {
  std::vector<std::int64_t> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  const std::size_t either = a.size() + b.size() - both.size();
  return either > 0 ? static_cast<double>(both.size()) / static_cast<double>(either) : 0;
}

std::vector<std::int64_t> featuresInside(const std::vector<FeatureTrack>& features, const Box2& box) {
  return idsOf(features, [&](const FeatureTrack& f) { return box.contains(f.pixel.x(), f.pixel.y()); });
}

std::vector<std::int64_t> featuresOnObject(const std::vector<FeatureTrack>& features, const Box2& box,
                                           const Proposal& proposal, const PinholeCamera& camera,
                                           double margin_m) {
  const Pose3 object_from_camera = proposal.camera_from_object.inverse();
  return idsOf(features, [&](const FeatureTrack& feature) {
    const double u = feature.pixel.x(), v = feature.pixel.y();
    if (!box.contains(u, v)) return false;
    if (feature.depth_m <= 0) return true;
    const Eigen::Vector3d point = object_from_camera * camera.backProject(u, v, feature.depth_m);
    return distanceOutside(proposal.shape, point).maxCoeff() <= margin_m;
  });
}

}  // namespace roomgraph
