// SPDX-License-Identifier: BSD-3-Clause
// Local maps as variables: their division, covariances, and what they are worth against summed steps.
#include "local_maps.h"

#include <gmock/gmock.h>

#include "circle_drive.h"
#include "roomgraph/estimation/graph_builder.h"
#include "roomgraph/geometry/covariance.h"

namespace roomgraph::test {
namespace {

using ::testing::ElementsAre;

const MotionSource kNone(MotionNoise{}, true);
constexpr double kMatch_m = 0.01, kMatch_rad = 0.004;

// Poses measured against a map that does not drift: errors of one match each, by the half second; none in the
// first, which is held.
MotionSource matched(unsigned seed) {
  Random random(seed);
  MotionSource source({1e-4, 0.01, 1e-4, 0.01, 0.003, 0.05, 0.05}, true);
  const auto noise = [&](double t, double sigma) {
    return t > 0 ? random.uniform(-1, 1) * std::sqrt(3.0) * sigma : 0;
  };
  const Matrix6d step =
      planarCovariance(Eigen::Vector3d(kMatch_m, kMatch_m, kMatch_rad).cwiseAbs2().asDiagonal());
  for (double t = 0; t <= kNodes; t += 0.5) {
    const double x = noise(t, kMatch_m), y = noise(t, kMatch_m), yaw = noise(t, kMatch_rad);
    source.add(t, toPose3(planarPart(truthAt(t)) * Pose2{x, y, yaw}), 0, step);
  }
  return source;
}

KeyPoses everySecond(const Motion& motion, int count) {
  KeyPoses poses(motion);
  for (int i = 0; i < count; ++i) poses.add(i, truthAt(i));
  return poses;
}

BackendOptions ofNodes(int nodes) {
  BackendOptions options;
  options.local_map_nodes = nodes;
  return options;
}

std::vector<std::array<std::size_t, 3>> divided(const MotionSource& source, std::size_t since) {
  const Motion motion{kNone, kNone, source};
  std::vector<std::array<std::size_t, 3>> out;
  for (const LocalMap& map : localMaps(everySecond(motion, 12), source, NodeId{100}, since, ofNodes(4))) {
    EXPECT_EQ(map.id, NodeId{static_cast<std::int64_t>(100 + map.first)});
    out.push_back({map.first, map.end, map.follows});
  }
  return out;
}

using Division = std::array<std::size_t, 3>;

TEST(LocalMaps, BeginAtFixedKeyPosesWhereverOneLooksFrom) {
  const MotionSource source = matched(1);
  EXPECT_THAT(divided(source, 0), ElementsAre(Division{0, 4, 0}, Division{4, 8, 1}, Division{8, 12, 1}));
  EXPECT_THAT(divided(source, 3), ElementsAre(Division{0, 4, 0}, Division{4, 8, 1}, Division{8, 12, 1}));
  EXPECT_THAT(divided(source, 6), ElementsAre(Division{4, 8, 0}, Division{8, 12, 1}));
  EXPECT_THAT(divided(source, 11), ElementsAre(Division{8, 12, 0}));
}

TEST(LocalMaps, BeginAnewAfterALossAndAreNotTiedAcrossIt) {
  MotionSource source({1e-3, 0, 1e-3, 0, 0}, true);
  for (const int t : {0, 1, 2, 5, 6, 7, 8, 9, 10, 11})
    source.add(t, truthAt(t), t < 5 ? 0 : 1, Matrix6d::Zero());
  EXPECT_THAT(divided(source, 0), ElementsAre(Division{0, 3, 0}, Division{5, 8, 0}, Division{8, 12, 1}));
  EXPECT_THAT(divided(source, 6), ElementsAre(Division{5, 8, 0}, Division{8, 12, 1}));
}

TEST(LocalMaps, FactorsAreCountedOnceEach) {
  const Motion motion{drifting(1.05, 1.08, kWheelNoise), kNone, matched(1)};
  const KeyPoses poses = everySecond(motion, 12);
  const auto factors = [&](int nodes, std::size_t since) {
    return buildWindow(poses, motion, {}, ofNodes(nodes), since, std::nullopt).graph.factors();
  };
  EXPECT_EQ(factors(0, 0), 11u + 11u + 11u) << "wheels, scans, floor";
  EXPECT_EQ(factors(4, 0), 11u + (12u + 2u) + 11u + 3u)
      << "wheels; scans: key poses in their maps, and between maps; floor: key poses and maps";
  EXPECT_EQ(factors(4, 6), 5u + (6u + 1u) + 5u + 2u);
}

double tiltOf(const Pose3& pose) {
  return std::acos(std::min(1.0, pose.linear()(2, 2)));
}

// Images that turn too far, and nod a little, against scans that do not: the maps of scans could escape by tilting,
// which scans do not measure, and the yaw would be the images'.
TEST(LocalMaps, OfScansStayLevelWhereImagesDisagree) {
  Random random(1);
  const auto nod = [&random] { return random.uniform(-0.004, 0.004); };
  const double turned_too_far = 0.01;
  const MotionSource level = drifting(1, 1 + turned_too_far, {});
  MotionSource images({0.001, 0.02, 0.0005, 0.02, 0.004, 0.05}, false);
  for (const StampedPose& seen : level.poses().poses())
    images.add(seen.t, seen.pose * poseFromYpr(0, 0, 0, 0, nod(), nod()), 0, 1e-5 * Matrix6d::Identity());
  const Motion motion{kNone, images, drifting(1, 1, kScanNoise)};
  const KeyPoses poses = everySecond(motion, kNodes);
  FactorGraph graph = buildGraph(poses, motion, {}, {}, ofNodes(5));
  ASSERT_TRUE(graph.optimize(100).usable);
  for (int first = 0; first < kNodes; first += 5)
    EXPECT_LT(tiltOf(graph.pose(NodeId{20'000'000 + first})), 0.002) << "map of scans from key pose " << first;
  // Of two chains of maps the one with the smaller variances leads.
  const double yaw = planarPart(truthAt(kNodes - 1).inverse() * graph.pose(NodeId{kNodes - 1})).yaw;
  EXPECT_GT(yaw, 0);
  EXPECT_LT(yaw, 0.25 * turned_too_far * 2 * M_PI) << "it is .8 of it where maps of scans may tilt";
}

// The same sums by hand: in a map one match, turned into the frame of the beginning; from map to map a share of all
// steps, as both ends are the source's own poses.
TEST(LocalMaps, ErrorsOfMatchesDoNotAddUp) {
  const MotionNoise noise{0.001, 0, 0.002, 0, 0, 0.1, 0.2};
  MotionSource source(noise, false), planar(noise, true);
  Vector6d along;
  along << 0.04, 0.0001, 0.0001, 1e-4, 1e-4, 1e-4;
  for (int i = 0; i <= 4; ++i)
    for (MotionSource* each : {&source, &planar})
      each->add(i, poseFromYpr(i, 0, 0, i * M_PI / 8, 0, 0), 0, Matrix6d(along.asDiagonal()));
  const Matrix6d in_map = source.inLocalMap(0, 4, 0)->covariance;
  EXPECT_NEAR(in_map(0, 0), 1e-6 + 0.0001, 1e-9) << "at the end the robot looks along y";
  EXPECT_NEAR(in_map(1, 1), 1e-6 + 0.04, 1e-9);
  EXPECT_NEAR(in_map(5, 5), 4e-6 + 1e-4, 1e-9);
  EXPECT_NEAR(source.inLocalMap(0, 2, 0)->covariance.trace(), in_map.trace(), 1e-9)
      << "as after half the way";
  const Matrix6d drift = source.betweenLocalMaps(0, 4, 0)->covariance, steps = source.between(0, 4, 0)->covariance;
  EXPECT_LT((drift.topLeftCorner<3, 3>() - 0.1 * steps.topLeftCorner<3, 3>()).norm(), 1e-12);
  EXPECT_LT((drift.bottomRightCorner<3, 3>() - 0.2 * steps.bottomRightCorner<3, 3>()).norm(), 1e-12);
  Matrix6d unmeasured = Matrix6d::Zero();
  for (int i : {2, 3, 4}) unmeasured(i, i) = 0.25;
  EXPECT_LT((planar.betweenLocalMaps(0, 4, 0)->covariance - drift - unmeasured).norm(), 1e-12);
  EXPECT_FALSE(source.inLocalMap(0, 5, 0.25));
}

// Wheels that are wrong by more than they say.
constexpr MotionNoise kSureWheels{0.005, 0.03, 0.003, 0.05, 0.03};

// Root mean square of the errors of all key poses, over many seeds.
double errorWith(int nodes) {
  double sum = 0;
  constexpr unsigned seeds = 30;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const Motion motion{drifting(1.05, 1.08, kSureWheels), kNone, matched(seed)};
    const KeyPoses poses = everySecond(motion, kNodes);
    FactorGraph graph = buildGraph(poses, motion, {}, {}, ofNodes(nodes));
    EXPECT_TRUE(graph.optimize().usable);
    for (int i = 0; i < kNodes; ++i)
      sum += (graph.pose(NodeId{i}).translation() - truthAt(i).translation()).squaredNorm();
  }
  return std::sqrt(sum / (seeds * kNodes));
}

TEST(LocalMaps, AreWorthMoreThanSteps) {
  const double steps = errorWith(0), maps = errorWith(10);
  EXPECT_LT(maps, 0.5 * steps) << "steps leave the wheels a say in every one of them";
  EXPECT_LT(maps, 1.5 * std::sqrt(2.0) * kMatch_m);
}

}  // namespace
}  // namespace roomgraph::test
