// SPDX-License-Identifier: BSD-3-Clause
// Sightings of the place by objects, scans and images, checked on the map's walls, and fixes afterwards.
#include "roomgraph/estimation/map_anchor.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/geometry/covariance.h"

namespace roomgraph {
namespace {

constexpr double kScanDistance_m = 0.1, kScanTurn_rad = 0.1;  // between two kept scans
constexpr std::size_t kMostScans = 25;
constexpr double kScansFor_s = 15;
constexpr int kLeastReturns = 60;
constexpr double kSearchEvery_s = 0.5, kViewEvery_s = 0.3;
constexpr double kSlowDown = 0.02;  // of the time without success: searching costs more than it brings
constexpr double kScanHolds_s = 2;  // after the latest scan the lidar tells no more where the robot is
constexpr double kHigh_m = 0.15, kTilted_rad = 0.1;  // of a robot on the floor, as an image tells
// A fix by a scan starts where the robot is thought to be.
constexpr double kFixReach_m = 0.3, kFixTurn_rad = 0.1, kFixTurn = 0.3;
// Errors of the map that fixes of one place share.
constexpr double kMapSigma_m = 0.02, kMapSigma_rad = 0.004;
constexpr double kViewSigma_m = 0.04, kViewSigma_rad = 0.015;
constexpr double kOtherVariance = 0.25;  // of z, roll and pitch, which scans do not tell

Pose3 planarFix(const Pose2& map_from_robot, const Pose3& now) {
  return toPose3(map_from_robot * planarPart(now).inverse()) * now;
}

bool onTheFloor(const Pose3& pose) {
  return std::abs(pose.translation().z()) < kHigh_m &&
         std::acos(std::clamp(pose.linear()(2, 2), -1.0, 1.0)) < kTilted_rad;
}

}  // namespace

MapAnchor::MapAnchor(CSemanticMap map, const RelocalisationOptions& options,
                     const ConstellationOptions& constellation)
    : map_(std::move(map)),
      options_(options),
      constellation_(constellation),
      locator_(map_.occupancy ? std::make_unique<GridLocator>(*map_.occupancy) : nullptr),
      views_(map_.views),
      consensus_(options) {}

bool MapAnchor::grounded() const { return hasScans() && latest_t_ - scans_.back().t < kScanHolds_s; }

// As often that enough places are remembered at once to agree.
double MapAnchor::pause(double quick_s, double since_s) const {
  return std::clamp(kSlowDown * since_s, quick_s, std::max(quick_s, options_.recent_s / (2.0 * options_.agreeing_alone)));
}

void MapAnchor::add(const Scan& scan, const KeyPoses& poses) {
  latest_t_ = std::max(latest_t_, scan.t);
  if (!locator_ || poses.empty()) return;
  if (scans_.size() > 1) {
    // The latest one is replaced until the robot has moved on.
    const Pose3 moved = poses.at(scans_[scans_.size() - 2].t).inverse() * poses.at(scans_.back().t);
    if (moved.translation().norm() < kScanDistance_m && rotationAngle(moved) < kScanTurn_rad)
      scans_.pop_back();
  }
  KeptScan kept{scan.t, {}};
  for (const auto& point : scan.pointsInRobot()) kept.in_robot.push_back(point.head<2>());
  scans_.push_back(std::move(kept));
  if (scans_.size() > kMostScans) scans_.erase(scans_.begin());
  std::erase_if(scans_, [&](const KeptScan& old) { return old.t < scan.t - kScansFor_s; });
}

void MapAnchor::add(const Frame& frame, const std::vector<Box2>& people, const KeyPoses& poses) {
  latest_t_ = std::max(latest_t_, frame.t);
  if (views_.empty() || poses.empty() || frame.t < next_view_t_) return;
  if (anchoring_ && grounded()) return;  // scans are more accurate
  if (first_t_ == 0) first_t_ = frame.t;
  next_view_t_ = frame.t + (anchoring_ ? kViewEvery_s : pause(kViewEvery_s, frame.t - first_t_));
  if (const auto match = views_.locate(frame, people))
    view_ = ViewAt{frame.t, match->world_from_camera * frame.robot_from_camera.inverse()};
}

// Of the last metres, in the robot's frame at the latest scan.
std::vector<Eigen::Vector2d> MapAnchor::recentReturns(const KeyPoses& poses) const {
  std::vector<Eigen::Vector2d> out;
  const Pose2 now = planarPart(poses.at(scans_.back().t));
  for (const KeptScan& scan : scans_) {
    const Pose2 now_from_robot = now.inverse() * planarPart(poses.at(scan.t));
    for (const auto& point : scan.in_robot) out.push_back(now_from_robot * point);
  }
  return out;
}

std::optional<GridFit> MapAnchor::fitOnWalls(const Pose2& map_from_robot, const KeyPoses& poses) const {
  const auto returns = recentReturns(poses);
  if (static_cast<int>(returns.size()) < kLeastReturns) return std::nullopt;
  const GridFit fit = locator_->refine(returns, map_from_robot);
  if (fit.explained < options_.min_explained || fit.contradicted > options_.max_contradicted)
    return std::nullopt;
  const Pose2 moved = map_from_robot.inverse() * fit.grid_from_points;
  if (std::hypot(moved.x, moved.y) > 2 * options_.tolerance_m ||
      std::abs(moved.yaw) > 2 * options_.tolerance_rad)
    return std::nullopt;
  return fit;
}

// What contradicts the walls, as the scans see them, is not said.
void MapAnchor::sight(PlaceSource source, double t, const Pose3& map_from_robot, const KeyPoses& poses) {
  Pose3 place = map_from_robot;
  if (hasScans()) {
    const Pose3 robot_from_now = poses.at(t).inverse() * poses.at(scans_.back().t);
    const auto fit = fitOnWalls(planarPart(map_from_robot * robot_from_now), poses);
    if (!fit) return;
    place = planarFix(fit->grid_from_points, map_from_robot * robot_from_now) * robot_from_now.inverse();
  }
  consensus_.add({source, t, place});
}

void MapAnchor::sightByObjects(const std::vector<Landmark>& seen, const KeyPoses& poses) {
  ConstellationOptions rule = constellation_;
  if (!grounded()) ++rule.min_pairs;
  const auto match = matchConstellation(seen, map_.landmarks, rule);
  if (!match) return;
  const KeyPose& node = poses.nodes().back();
  sight(PlaceSource::kObjects, node.t, toPose3(match->map_from_query) * node.world_from_robot, poses);
}

void MapAnchor::sightByScans(const KeyPoses& poses) {
  if (!grounded() || scans_.back().t < next_search_t_) return;
  const double now = scans_.back().t;
  if (first_t_ == 0) first_t_ = now;
  next_search_t_ = now + pause(kSearchEvery_s, now - first_t_);
  const auto places = locator_->places(recentReturns(poses));
  if (places.empty()) return;
  if (places.size() > 1 && places[1].score > options_.ambiguity_ratio * places[0].score) return;
  sight(PlaceSource::kScans, now, planarFix(places[0].grid_from_points, poses.at(now)), poses);
}

void MapAnchor::sightByImage(const KeyPoses& poses, bool planar) {
  if (!view_) return;
  if (!planar || onTheFloor(view_->map_from_robot))
    sight(PlaceSource::kImages, view_->t, view_->map_from_robot, poses);
  view_.reset();
}

std::optional<Pose3> MapAnchor::recognise(const std::vector<Landmark>& seen, const KeyPoses& poses,
                                          bool planar) {
  if (anchoring_) return std::nullopt;
  const auto tell = [&](auto&& source) -> std::optional<ConfirmedPlace> {
    source();
    return consensus_.confirmed(poses);
  };
  auto place = tell([&] { sightByImage(poses, planar); });
  if (!place) place = tell([&] { sightByScans(poses); });
  if (!place) place = tell([&] { sightByObjects(seen, poses); });
  if (!place) return std::nullopt;
  Pose3 map_from_world = place->map_from_world;
  if (planar) map_from_world = toPose3(planarPart(map_from_world));
  anchoring_ = Anchoring{map_from_world, poses.nodes().back().t, place->sources};
  return map_from_world;
}

std::optional<MapFix> MapAnchor::fixByScan(const KeyPoses& poses) const {
  const KeptScan& scan = scans_.back();
  if (static_cast<int>(scan.in_robot.size()) < kLeastReturns) return std::nullopt;
  const Pose3 robot = poses.at(scan.t);
  const Pose2 start = planarPart(robot);
  const GridFit fit = locator_->refine(scan.in_robot, start);
  const Pose2 moved = start.inverse() * fit.grid_from_points;
  if (fit.explained < options_.min_explained || std::hypot(moved.x, moved.y) > kFixReach_m ||
      std::abs(moved.yaw) > kFixTurn_rad)
    return std::nullopt;
  Eigen::Matrix3d covariance = fit.covariance;
  covariance.diagonal() += Eigen::Vector3d(kMapSigma_m, kMapSigma_m, kMapSigma_rad).cwiseAbs2();
  return MapFix{scan.t, planarFix(fit.grid_from_points, robot), planarCovariance(covariance, kOtherVariance)};
}

std::optional<MapFix> MapAnchor::fix(const KeyPoses& poses) {
  if (!anchoring_) return std::nullopt;
  latest_t_ = std::max(latest_t_, poses.nodes().back().t);
  const Pose3 here = poses.nodes().back().world_from_robot;
  if (last_fix_from_) {
    const Pose3 moved = last_fix_from_->inverse() * here;
    if (moved.translation().norm() < options_.fix_distance_m && rotationAngle(moved) < kFixTurn)
      return std::nullopt;
  }
  std::optional<MapFix> out;
  if (grounded()) {
    // Each scan once: its errors, and those of the map there, would count as many times.
    if (scans_.back().t > fixed_scan_t_) out = fixByScan(poses);
    if (out) fixed_scan_t_ = out->t;
  } else if (view_) {
    Vector6d sigma;
    sigma << Eigen::Vector3d::Constant(kViewSigma_m), Eigen::Vector3d::Constant(kViewSigma_rad);
    out = MapFix{view_->t, view_->map_from_robot, Matrix6d(sigma.cwiseAbs2().asDiagonal())};
    view_.reset();
  }
  if (out) last_fix_from_ = here;
  return out;
}

}  // namespace roomgraph
