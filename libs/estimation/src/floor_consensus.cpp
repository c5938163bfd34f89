// SPDX-License-Identifier: BSD-3-Clause
// Counting of planes that agree in direction and in height below the camera.
#include "roomgraph/estimation/floor_consensus.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace roomgraph {
namespace {

constexpr double kMemory_s = 10;
constexpr std::size_t kLeastAgreeing = 3;
// A plane must be seen for so long; one that is nearer to the camera than a standing person's floor, for
// longer.
constexpr double kLeastTime_s = 0.2, kUsualHeight_m = 0.8, kLeastTimeNear_s = 3;
// Sightings of one plane: depth noise, and the drift of a camera within kMemory_s.
constexpr double kSameDirection_rad = 0.08, kSameHeight_m = 0.08;
constexpr double kClearlyBelow_m = 0.2;  // less than the height of any table

double angleBetween(const Plane& a, const Plane& b) {
  return std::atan2(a.normal.cross(b.normal).norm(), a.normal.dot(b.normal));
}

Plane meanOf(const std::vector<const Plane*>& planes) {
  Plane mean{Eigen::Vector3d::Zero(), 0};
  for (const Plane* plane : planes) {
    mean.normal += plane->normal;
    mean.offset += plane->offset / static_cast<double>(planes.size());
  }
  mean.normal.normalize();
  return mean;
}

}  // namespace

std::optional<Plane> FloorConsensus::add(double t, const Plane& in_world,
                                         const Eigen::Vector3d& camera_in_world) {
  sightings_.push_back({t, in_world});
  std::erase_if(sightings_, [t](const Sighting& s) { return t - s.t > kMemory_s; });
  const double height = in_world.distance(camera_in_world);
  std::vector<const Plane*> agreeing;
  std::size_t below = 0;
  double since = t;
  for (const Sighting& s : sightings_) {
    if (angleBetween(s.plane, in_world) > kSameDirection_rad) continue;
    const double lower = s.plane.distance(camera_in_world) - height;
    below += lower > kClearlyBelow_m;
    if (std::abs(lower) > kSameHeight_m) continue;
    agreeing.push_back(&s.plane);
    since = std::min(since, s.t);
  }
  const double least = height < kUsualHeight_m ? kLeastTimeNear_s : kLeastTime_s;
  if (below >= kLeastAgreeing || agreeing.size() < kLeastAgreeing || t - since < least) return std::nullopt;
  return meanOf(agreeing);
}

bool contradictsFloor(const Plane& in_world, const Eigen::Vector3d& camera_in_world) {
  const Plane level;
  const double lower = in_world.distance(camera_in_world) - level.distance(camera_in_world);
  if (lower > kClearlyBelow_m) return true;
  return lower > -kSameHeight_m && angleBetween(in_world, level) > kSameDirection_rad;
}

}  // namespace roomgraph
