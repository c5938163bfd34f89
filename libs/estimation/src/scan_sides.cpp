// SPDX-License-Identifier: BSD-3-Clause
// Assignment of returns to sides by distance and direction; thinning and weights.
#include "scan_sides.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "direction_bin.h"
#include "object_weights.h"

namespace roomgraph {
namespace {

constexpr double kReach_m = 5;  // of a lidar that looks at a landmark
// Of a return to the side that it may lie on: legs of somebody who sits there stand farther off.
constexpr double kNearSide_m = 0.12;
constexpr double kNearWall_m = 0.1;    // likewise, of a wall: walls are well known
constexpr double kNearLegs_m = 0.15;   // outside a cylinder
constexpr double kSameThing_m = 0.1;   // between neighbouring returns on one surface
constexpr double kLeastFacing = 0.25;  // cosine between the side's normal and the direction to the lidar
constexpr double kCorner_m = 0.05;     // at the ends of a side returns may be on the next one
constexpr double kWallBeside_m = 1.2;  // of the wall on both sides of a door
constexpr double kLeastShown = 0.5;    // share of the length of a cuboid's side that returns must lie along
constexpr double kSpread_m = 0.05, kMostAlike = 0.7;        // so many of a side's returns are so near a line
constexpr std::size_t kLeastOnSide = 4, kMostOnSide = 6;  // of one side in one scan

// In the landmark's frame.
struct Side {
  Eigen::Vector2d outward;
  double to_side_m;      // of the landmark's middle
  double half_length_m;  // along the side
};

std::array<Side, 4> sidesOf(const ObjectShape& shape) {
  const Eigen::Vector2d x = Eigen::Vector2d::UnitX(), y = Eigen::Vector2d::UnitY();
  return {{{x, shape.depth / 2, shape.width / 2},
           {-x, shape.depth / 2, shape.width / 2},
           {y, shape.width / 2, shape.depth / 2},
           {-y, shape.width / 2, shape.depth / 2}}};
}

struct Return {
  Eigen::Vector2d in_landmark;
  Eigen::Vector3d in_robot;
};

double distance(const Side& side, const Eigen::Vector2d& point) {
  return side.outward.dot(point) - side.to_side_m;
}

double along(const Side& side, const Eigen::Vector2d& point) {
  return side.outward.x() * point.y() - side.outward.y() * point.x();
}

// A door's leaf may be anywhere, its frame is in the wall.
bool isOn(const Side& side, ShapeKind kind, const Eigen::Vector2d& point) {
  const double beside = std::abs(along(side, point)) - side.half_length_m;
  if (kind == ShapeKind::kPlanar)
    return std::abs(distance(side, point)) < kNearWall_m && beside > kCorner_m && beside < kWallBeside_m;
  return std::abs(distance(side, point)) < kNearSide_m && beside < -kCorner_m;
}

// Whether most returns lie on a line: the least-squares one along the side.
bool onALine(const Side& side, const std::vector<Return>& returns) {
  Eigen::MatrixXd places(returns.size(), 2);
  Eigen::VectorXd distances(returns.size());
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    places.row(row) << 1, along(side, returns[i].in_landmark);
    distances[row] = distance(side, returns[i].in_landmark);
  }
  const Eigen::VectorXd line = places.colPivHouseholderQr().solve(distances);
  const auto alike = ((places * line - distances).cwiseAbs().array() < kSpread_m).count();
  return static_cast<double>(alike) >= kMostAlike * static_cast<double>(returns.size());
}

// Whether the returns lie along enough of a cuboid's side to be the side, not somebody's legs before it.
bool showsTheSide(const Side& side, const std::vector<Return>& returns) {
  const auto [first, last] =
      std::minmax_element(returns.begin(), returns.end(), [&side](const Return& a, const Return& b) {
        return along(side, a.in_landmark) < along(side, b.in_landmark);
      });
  return along(side, last->in_landmark) - along(side, first->in_landmark) >
         kLeastShown * 2 * side.half_length_m;
}

using Returns = std::vector<Return>::const_iterator;

// Behind the last return of the surface that the first one lies on, in the order of the beams.
Returns endOfSurface(Returns first, Returns end) {
  const auto gap = std::adjacent_find(first, end, [](const Return& a, const Return& b) {
    return (a.in_landmark - b.in_landmark).norm() > kSameThing_m;
  });
  return gap == end ? end : gap + 1;
}

// One scan, placed. Its points are computed when a landmark is in reach.
class PosedScan {
 public:
  PosedScan(const Scan& scan, const KeyPoses& poses)
      : scan_(scan),
        node_(poses.nearest(scan.t)),
        node_from_robot_(poses.offset(node_, scan.t)),
        world_from_lidar_(node_.world_from_robot * node_from_robot_ * scan.robot_from_lidar) {}

  double t() const { return scan_.t; }
  NodeId node() const { return node_.id; }
  Eigen::Vector2d lidar() const { return world_from_lidar_.translation().head<2>(); }
  double height_m() const { return world_from_lidar_.translation().z(); }
  const std::vector<Eigen::Vector3d>& inNode() { return points().in_node; }
  const std::vector<Eigen::Vector2d>& inWorld() { return points().in_world; }

 private:
  struct Points {
    std::vector<Eigen::Vector3d> in_node;
    std::vector<Eigen::Vector2d> in_world;
  };
  const Points& points() {
    if (points_) return *points_;
    points_.emplace();
    points_->in_node = scan_.pointsInRobot();
    points_->in_world.reserve(points_->in_node.size());
    for (Eigen::Vector3d& point : points_->in_node) {
      point = node_from_robot_ * point;
      points_->in_world.push_back((node_.world_from_robot * point).head<2>());
    }
    return *points_;
  }

  const Scan& scan_;
  const KeyPose& node_;
  Pose3 node_from_robot_, world_from_lidar_;
  std::optional<Points> points_;
};

class SideFinder {
 public:
  SideFinder(const Landmark& landmark, const ObjectModel& model, const BackendOptions& options)
      : landmark_(landmark),
        options_(options),
        solid_m_(landmark.shape.kind == ShapeKind::kCuboid ? model.solid_share * landmark.shape.height
                                                           : landmark.shape.height),
        reach_m_(landmark.shape.horizontalExtent() / 2 + kWallBeside_m),
        landmark_from_world_(planarPart(landmark.worldFromObject()).inverse()) {}

  void add(PosedScan& scan) {
    if (landmark_.stands_since && scan.t() < *landmark_.stands_since) return;
    const Eigen::Vector2d lidar = landmark_from_world_ * scan.lidar();
    if (scan.height_m() < 0 || scan.height_m() > solid_m_ || lidar.norm() > kReach_m) return;
    const std::vector<Return> near = around(scan);
    if (landmark_.shape.kind == ShapeKind::kCylinder) return addInside(scan, near);
    for (const Side& side : sidesOf(landmark_.shape)) {
      const bool face = std::abs(side.outward.x()) > 0.5;
      if (landmark_.shape.kind == ShapeKind::kPlanar && !face) continue;
      const Eigen::Vector2d to_lidar = lidar - side.to_side_m * side.outward;
      if (side.outward.dot(to_lidar) < kLeastFacing * to_lidar.norm()) continue;
      addSide(scan, side, near);
    }
  }

  // Those from one direction weigh as much as their mean.
  std::vector<LandmarkSideFactor> factors() const {
    std::vector<LandmarkSideFactor> out;
    for (const auto& [direction, all] : by_direction_) {
      const auto group = thinned(all, kMostOfDirection);
      for (LandmarkSideFactor factor : group) {
        factor.weight = weightAmong(group.size(), options_.landmark_repeating_share);
        out.push_back(factor);
      }
    }
    return out;
  }

 private:
  std::vector<Return> around(PosedScan& scan) const {
    std::vector<Return> out;
    const auto& places = scan.inWorld();
    const Pose2& to = landmark_from_world_;
    const double c = std::cos(to.yaw), s = std::sin(to.yaw);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if ((places[i] - landmark_.position.head<2>()).norm() > reach_m_) continue;
      const double x = places[i].x(), y = places[i].y();
      out.push_back({{to.x + c * x - s * y, to.y + s * x + c * y}, scan.inNode()[i]});
    }
    return out;
  }

  void addSide(const PosedScan& scan, const Side& side, const std::vector<Return>& near) {
    std::vector<Return> on_side;
    for (const Return& r : near)
      if (isOn(side, landmark_.shape.kind, r.in_landmark)) on_side.push_back(r);
    if (on_side.size() < kLeastOnSide || !onALine(side, on_side)) return;
    if (landmark_.shape.kind == ShapeKind::kCuboid && !showsTheSide(side, on_side)) return;
    for (const Return& r : thinned(on_side, kMostOnSide)) keep(scan, r, side.outward);
  }

  // Of what goes on beyond the reach of legs, a wall or a desk, nothing is a leg.
  void addInside(const PosedScan& scan, const std::vector<Return>& near) {
    const double most = landmark_.shape.horizontalExtent() / 2 + kNearLegs_m;
    for (auto first = near.begin(); first != near.end();) {
      const auto end = endOfSurface(first, near.end());
      const bool legs =
          std::all_of(first, end, [most](const Return& r) { return r.in_landmark.norm() < most; });
      for (; first != end; ++first)
        if (legs) keep(scan, *first, Eigen::Vector2d::UnitX());
    }
  }

  void keep(const PosedScan& scan, const Return& r, const Eigen::Vector2d& outward) {
    const Eigen::Vector2d ray = landmark_.position.head<2>() - scan.lidar();
    by_direction_[directionBin(ray, options_.landmark_view_rad)].push_back({.node = scan.node(),
                                        .landmark = landmark_.id,
                                        .point_in_robot = r.in_robot,
                                        .outward = outward,
                                        .sigma_m = options_.side_sigma_m,
                                        .robust_width = options_.landmark_robust_width});
  }

  const Landmark& landmark_;
  const BackendOptions& options_;
  double solid_m_;  // below, the landmark stops a beam
  double reach_m_;
  Pose2 landmark_from_world_;
  std::map<int, std::vector<LandmarkSideFactor>> by_direction_;
};

}  // namespace

std::vector<LandmarkSideFactor> scanSides(const KeptScans& scans, const KeyPoses& poses,
                                          const std::vector<Landmark>& landmarks,
                                          const ObjectDatabase& database, const BackendOptions& options) {
  std::vector<SideFinder> finders;
  for (const Landmark& landmark : landmarks)
    if (const ObjectModel* model = database.find(landmark.model))
      finders.emplace_back(landmark, *model, options);
  if (finders.empty() || poses.empty()) return {};
  for (const auto& scan : scans) {
    PosedScan posed(*scan, poses);
    for (SideFinder& finder : finders) finder.add(posed);
  }
  std::vector<LandmarkSideFactor> out;
  for (const SideFinder& finder : finders)
    for (const LandmarkSideFactor& factor : finder.factors()) out.push_back(factor);
  return out;
}

}  // namespace roomgraph
