// SPDX-License-Identifier: BSD-3-Clause
// Sides of landmarks in scans: beams cast against walls and boxes by this test; places, yaws and variances
// found again.
#include "scan_sides.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "roomgraph/backend/factor_graph.h"
#include "shipped_objects.h"
#include "still_camera.h"

namespace roomgraph::test {
namespace {

using Segment = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

// Distance along a beam to a segment.
std::optional<double> hit(const Eigen::Vector2d& from, const Eigen::Vector2d& beam, const Segment& segment) {
  const Eigen::Vector2d edge = segment.second - segment.first, gap = segment.first - from;
  const double determinant = edge.x() * beam.y() - edge.y() * beam.x();
  if (std::abs(determinant) < 1e-12) return std::nullopt;
  const double range = (edge.x() * gap.y() - edge.y() * gap.x()) / determinant;
  const double share = (beam.x() * gap.y() - beam.y() * gap.x()) / determinant;
  if (range <= 0 || share < 0 || share > 1) return std::nullopt;
  return range;
}

class ScanSides : public ::testing::Test {
 protected:
  // A key pose, with a scan of everything in `segments_` from .2 m above it.
  void look(double x, double y, double yaw, double lidar_height_m = 0.2) {
    const double t = static_cast<double>(scans_.size());
    poses_.add(t, poseFromYpr(x, y, 0, yaw, 0, 0));
    Scan scan;
    scan.t = t;
    scan.angle_min_rad = -M_PI;
    scan.angle_step_rad = M_PI / 360;
    scan.max_range_m = 20;
    scan.robot_from_lidar.translation().z() = lidar_height_m;
    for (int i = 0; i < 720; ++i) {
      const double angle = yaw + scan.angle_min_rad + i * scan.angle_step_rad;
      double range = 0;
      for (const Segment& segment : segments_)
        if (const auto found = hit({x, y}, {std::cos(angle), std::sin(angle)}, segment);
            found && (range == 0 || *found < range))
          range = *found;
      scan.ranges_m.push_back(static_cast<float>(range));
      scan.valid.push_back(range > 0);
    }
    scans_.push_back(std::make_shared<Scan>(scan));
  }
  void addOutline(const Landmark& object) {
    const auto corners = footprintAt(planarPart(object.worldFromObject()), object.shape);
    for (std::size_t i = 0; i < corners.size(); ++i)
      segments_.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
  }
  std::vector<LandmarkSideFactor> sides(const Landmark& landmark) const {
    return scanSides(scans_, poses_, {landmark}, shippedObjects(), options_);
  }
  // The landmark where the sides say it is, with a weak idea of where it was thought to be.
  LandmarkEstimate settled(const Landmark& landmark) const {
    FactorGraph graph;
    for (const auto& node : poses_.nodes()) graph.addPose(node.id, node.world_from_robot, true);
    graph.addLandmark(landmark.id, {landmark.position, landmark.yaw, landmark.shape});
    LandmarkFactor thought{poses_.nodes()[0].id, landmark.id};
    const Pose3 in_robot = poses_.nodes()[0].world_from_robot.inverse() * landmark.worldFromObject();
    thought.position_in_robot = in_robot.translation();
    thought.yaw_in_robot = planarPart(in_robot).yaw;
    thought.has_yaw = landmark.has_yaw;
    graph.add(thought);
    for (const auto& side : sides(landmark)) graph.add(side);
    EXPECT_TRUE(graph.optimize().usable);
    return graph.landmark(landmark.id);
  }
  static Landmark object(const char* name, double x, double y, double yaw) {
    const ObjectModel& model = *shippedObjects().find(name);
    Landmark out;
    out.id = LandmarkId{5};
    out.class_name = out.model = name;
    out.position = {x, y, 0};
    out.yaw = yaw;
    out.shape = model.nominal();
    out.has_yaw = out.shape.kind != ShapeKind::kCylinder;
    return out;
  }

  KeyPoses poses_{standing()};
  BackendOptions options_;
  std::vector<Segment> segments_;
  KeptScans scans_;
};

TEST_F(ScanSides, MoveASofaToItsSides) {
  const Landmark truth = object("sofa", 3, 0.5, M_PI - 0.3);
  addOutline(truth);
  look(0, 0, 0), look(1, 2, -0.8), look(1.5, 3, -1.2);
  Landmark thought = truth;
  thought.position += Eigen::Vector3d(0.09, -0.06, 0);
  thought.yaw += 0.06;
  const LandmarkEstimate found = settled(thought);
  EXPECT_LT((found.position - truth.position).head<2>().norm(), 0.01);
  EXPECT_NEAR(wrapAngle(found.yaw - truth.yaw), 0, 0.01);
}

TEST_F(ScanSides, BeforeItStoodThereShowSomethingElse) {
  Landmark sofa = object("sofa", 3, 0.5, M_PI - 0.3);
  addOutline(sofa);
  look(0, 0, 0), look(0.2, 0, 0);
  const auto both = sides(sofa);
  sofa.stands_since = 0.5;
  const auto later = sides(sofa);
  EXPECT_LT(later.size(), both.size());
  ASSERT_FALSE(later.empty());
  for (const auto& side : later) EXPECT_EQ(side.node, poses_.nodes()[1].id);
}

TEST_F(ScanSides, MoveADoorIntoTheWallWhoseFaceIsSeen) {
  const Landmark truth = object("door", 2, 0.3, M_PI);
  const double face = 2 - truth.shape.depth / 2;
  // Wall beside the doorway; the leaf stands open, at a right angle into the next room.
  segments_ = {{{face, -3}, {face, 0.3 - 0.45}},
               {{face, 0.3 + 0.45}, {face, 3}},
               {{face, 0.3 + 0.45}, {face + 0.9, 0.3 + 0.45}}};
  look(0, 0, 0.4), look(0.5, 1, -0.2);
  Landmark thought = truth;
  thought.position.x() += 0.04;
  thought.yaw -= 0.04;
  const LandmarkEstimate found = settled(thought);
  EXPECT_NEAR(found.position.x(), 2, 0.005);
  EXPECT_NEAR(found.position.y(), 0.3, 0.06) << "along the wall it says little";
  EXPECT_NEAR(wrapAngle(found.yaw - truth.yaw), 0, 0.01);
}

TEST_F(ScanSides, LegsStandInsideAChair) {
  const Landmark truth = object("swivel_chair", 2, 0, 0);
  for (const double angle : {0.3, 1.6, 2.8, 4.1, 5.3}) {  // legs of .3 m, 4 cm wide at their ends
    const Eigen::Vector2d end =
        truth.position.head<2>() + 0.3 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    segments_.emplace_back(end - Eigen::Vector2d(0.02, 0.02), end + Eigen::Vector2d(0.02, 0.02));
    segments_.emplace_back(end - Eigen::Vector2d(0.02, -0.02), end + Eigen::Vector2d(0.02, -0.02));
  }
  look(0, 0, 0), look(2, -2, 1.5), look(3.5, 1, 0);
  Landmark thought = truth;
  thought.position += Eigen::Vector3d(0.1, 0.05, 0);
  EXPECT_LT((settled(thought).position - truth.position).norm(), 0.05);
}

TEST_F(ScanSides, AWallBesideAChairIsNoLeg) {
  const Landmark chair = object("swivel_chair", 2, 0, 0);
  segments_ = {{{2.36, -3}, {2.36, 3}}};  // .05 m behind it
  look(0, 0, 0);
  EXPECT_TRUE(sides(chair).empty());
  segments_.push_back({{2.05, -0.02}, {2.05, 0.02}});
  look(0, 0, 0);
  EXPECT_FALSE(sides(chair).empty()) << "its column";
  for (const auto& side : sides(chair)) EXPECT_NEAR(side.point_in_robot.x(), 2.05, 0.01);
}

TEST_F(ScanSides, NothingAboveWhatIsSolid) {
  const Landmark sofa = object("sofa", 2, 0, M_PI);
  addOutline(sofa);
  look(0, 0, 0, 0.5);
  EXPECT_TRUE(sides(sofa).empty()) << "over the seat";
  look(0, 0, 0, 0.2);
  EXPECT_FALSE(sides(sofa).empty());
}

TEST_F(ScanSides, NothingOfWhatDoesNotLieOnALine) {
  const Landmark sofa = object("sofa", 2, 0, M_PI);
  const double front = 2 - sofa.shape.depth / 2;
  for (int i = 0; i < 12; ++i) {  // a heap before it
    const double y = -0.6 + 0.1 * i, x = front + (i % 2 == 0 ? -0.18 : 0.12);
    segments_.emplace_back(Eigen::Vector2d(x, y), Eigen::Vector2d(x, y + 0.08));
  }
  look(0, 0, 0);
  EXPECT_TRUE(sides(sofa).empty());
}

TEST_F(ScanSides, FarAwayOrFromBehindNothing) {
  const Landmark sofa = object("sofa", 9, 0, M_PI);
  addOutline(sofa);
  look(0, 0, 0);
  EXPECT_TRUE(sides(sofa).empty()) << "too far";
  Landmark turned = sofa;
  look(6, 0, 0);
  turned.position.x() = 9 + sofa.shape.depth;  // its front is where the back is: nothing near it
  EXPECT_TRUE(sides(turned).empty());
}

// n returns from one direction, with the share rho of their variance in common, tell a side to
// sigma^2 (rho + (1 - rho) / n).
TEST_F(ScanSides, ReturnsFromOneDirectionAreWorthTheirMean) {
  const Landmark sofa = object("sofa", 3, 0, M_PI);
  addOutline(sofa);
  for (int i = 0; i < 8; ++i) look(0.02 * i, 0, 0);
  double information = 0;
  const auto found = sides(sofa);
  for (const auto& side : found) information += side.weight / (side.sigma_m * side.sigma_m);
  const double n = static_cast<double>(found.size()), rho = options_.landmark_repeating_share;
  ASSERT_GT(n, 10);
  EXPECT_NEAR(1 / information, std::pow(options_.side_sigma_m, 2) * (rho + (1 - rho) / n), 1e-9);
}

}  // namespace
}  // namespace roomgraph::test
