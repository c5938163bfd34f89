// SPDX-License-Identifier: BSD-3-Clause
// Door hypotheses from a vertical plane in the depth or from the image.
#include "door_generator.h"

#include <algorithm>
#include <cmath>

#include "door_from_image.h"
#include "door_in_wall.h"
#include "door_on_plane.h"
#include "roomgraph/proposals/shape_fit.h"
#include "vertical_plane.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(DoorGenerator, ShapeGenerator, roomgraph)

namespace {

constexpr double kMinHeight = 0.15;  // m; lower points may be floor
constexpr double kInset = 0.08;  // of the box's width, at both sides: there the points are the door frame's
constexpr double kMaybeOpen_m = 0.25,
                 kMaybeOpen_rad = 0.6;  // standard deviations of the doorway from a leaf that may be open
constexpr double kOfOpenLeaf = 0.3;     // of the quality: the leaf tells that there is a door, but not where
constexpr double kHeightGate = 2;       // standard deviations by which the height may differ from the usual

std::vector<Eigen::Vector2d> footprintPoints(const BoxEvidence& e) {
  const double inset = kInset * e.box.width();
  std::vector<Eigen::Vector2d> points;
  for (const auto& p : e.all.points)
    if (p.in_ground.z() > kMinHeight && p.u > e.box.u_min + inset && p.u < e.box.u_max - inset)
      points.push_back(p.in_ground.head<2>());
  return points;
}

// The points may be on an open leaf: the door is then somewhere beside it, in another direction.
void addDoubt(PlacedShape& placed) {
  placed.covariance->topLeftCorner<2, 2>() += std::pow(kMaybeOpen_m, 2) * Eigen::Matrix2d::Identity();
  (*placed.covariance)(2, 2) += std::pow(kMaybeOpen_rad, 2);
}

// Adjusts the height to the box's top side when it is not cut: the top of the door's nearer side is seen
// there.
void adjustHeight(PlacedShape& placed, const BoxEvidence& e) {
  const Eigen::Vector3d up = e.camera_from_ground.linear().col(2);
  if (e.cut.top || -up.y() <= std::abs(up.x())) return;  // of a camera on its side the image's top is a side of the door
  const Eigen::Vector2d half =
      0.5 * placed.shape.width * Eigen::Vector2d(-std::sin(placed.yaw), std::cos(placed.yaw));
  const Eigen::Vector2d center(placed.x, placed.y);
  const double range = std::min((center + half).norm(), (center - half).norm());
  const Eigen::Vector3d ray =
      e.camera_from_ground.linear().transpose() * e.camera.ray(e.box.center().x(), e.box.v_min);
  const double seen =
      e.camera_from_ground.inverse().translation().z() + ray.z() / ray.head<2>().norm() * range;
  const double seen_sigma = range / e.camera.fy * sideSigma(e.box.height());
  const double usual = e.model->height_m, sigma = e.model->sizeSigma()[2];
  const double gain = sigma * sigma / (sigma * sigma + seen_sigma * seen_sigma);
  placed.shape.height = usual + std::clamp(gain * (seen - usual), -kHeightGate * sigma, kHeightGate * sigma);
  placed.size_information[2] = 1 / (seen_sigma * seen_sigma);
}

}  // namespace

std::vector<PlacedShape> DoorGenerator::generate(const BoxEvidence& evidence,
                                                 const GeneratorLimits& limits) const {
  std::vector<PlacedShape> guesses;
  const auto leaf = fitVerticalPlane(footprintPoints(evidence));
  auto in_wall = doorInWall(leaf, evidence);
  if (!in_wall) in_wall = doorSeenThrough(leaf, evidence);
  if (in_wall) {
    adjustHeight(*in_wall, evidence);
    return keepBest({*in_wall}, {}, limits);
  }
  if (leaf) {
    // The points are on the leaf, which is flush with the wall or up to half of the frame's depth behind its
    // face: the middle of both.
    if (const auto placed = doorOnPlane(*leaf, evidence, evidence.model->depth_m / 4)) {
      guesses.push_back(*placed);
      guesses.back().source = "depth plane";
      if (!isClosed(*leaf, evidence)) addDoubt(guesses.back());
    }
  } else {
    guesses = doorsFromImage(evidence);
  }
  for (PlacedShape& placed : guesses) {
    placed.supported = leaf.has_value();
    adjustHeight(placed, evidence);
    judge(placed, evidence);
  }
  if (leaf && !guesses.empty()) {
    if (const auto doorway = doorwayOfLeaf(*leaf, guesses.front(), evidence)) {
      guesses = {*doorway};
    } else if (standsOpen(*leaf, evidence) || isFurniture(*leaf, evidence)) {
      addDoubt(guesses.front());
      guesses.front().quality *= kOfOpenLeaf;
    }
  }
  return keepBest(guesses, {}, limits);
}

}  // namespace roomgraph
