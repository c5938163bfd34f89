// SPDX-License-Identifier: BSD-3-Clause
// Processor time of window and whole-graph optimisation (disabled by default).
#include <gtest/gtest.h>

#include <ctime>
#include <iostream>

#include "simulated_loop.h"
#include "sliding_window.h"

namespace roomgraph::test {
namespace {

// What the back end costs, as processor time. Not judged, so not run by default:
//   backend_test --gtest_also_run_disabled_tests --gtest_filter='*Timing*'

double now_ms() {
  return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

const ObjectShape kChair{ShapeKind::kCylinder, 0.6, 0.6, 0.9};

Pose3 onCircle(int i) {
  const double angle = 0.05 * i;
  return poseFromYpr(4 * std::cos(angle), 4 * std::sin(angle), 0, angle + M_PI / 2, 0, 0);
}

LandmarkEstimate chair(int k) {
  const double angle = 2.4 * k, radius = 1 + 0.1 * k;
  return {{radius * std::cos(angle), radius * std::sin(angle), 0}, 0, kChair};
}

Factor movement(int a, Random& random) {
  BetweenFactor f{NodeId{a}, NodeId{a + 1}, onCircle(a).inverse() * onCircle(a + 1)};
  f.covariance = Matrix6d::Identity() * 1e-4;
  for (int i = 0; i < 3; ++i) f.a_from_b.translation()[i] += 0.01 * gauss(random);
  return f;
}

Factor sighting(int i, int k, Random& random) {
  LandmarkFactor f{NodeId{i}, LandmarkId{k}};
  f.position_in_robot = onCircle(i).inverse() * chair(k).position;
  for (int r = 0; r < 3; ++r) f.position_in_robot[r] += 0.05 * gauss(random);
  f.covariance = Eigen::Matrix4d::Identity() * 0.0025;
  return f;
}

TEST(Timing, DISABLED_WindowWithTenLandmarks) {
  for (std::size_t size : {6u, 10u, 15u}) {
    Random random(1);
    SlidingWindow window(size, true, SolveOptions{}.function_tolerance);
    for (int k = 0; k < 10; ++k) window.addLandmark(LandmarkId{k}, chair(k));
    double first = 0, last = 0;
    for (int i = 0; i < 300; ++i) {
      std::vector<Factor> factors{PlanarFactor{NodeId{i}}};
      if (i > 0) factors.push_back(movement(i - 1, random));
      for (int k = 0; k < 10; ++k) factors.push_back(sighting(i, k, random));
      const double start = now_ms();
      window.step(NodeId{i}, onCircle(i), factors);
      (i < 150 ? first : last) += (now_ms() - start) / 150;
    }
    std::cout << "window of " << size << " poses, 10 landmarks: " << first << " ms per pose, then " << last
              << " ms\n";
  }
}

TEST(Timing, DISABLED_WholeGraph) {
  Random random(1);
  const double start = now_ms();
  FactorGraph graph;
  for (int i = 0; i < 1500; ++i)
    graph.addPose(NodeId{i}, onCircle(i) * random.pose(i ? 0.05 : 0, 0.02), i == 0);
  for (int k = 0; k < 30; ++k) graph.addLandmark(LandmarkId{k}, chair(k));
  for (int i = 0; i + 1 < 1500; ++i) graph.add(movement(i, random));
  for (int i = 0; i < 1500; ++i) graph.add(PlanarFactor{NodeId{i}});
  for (int n = 0; n < 5000; ++n) graph.add(sighting(n * 3 / 10, n % 30, random));
  const double built = now_ms();
  const SolveReport report = graph.optimize();
  const double solved = now_ms();
  ASSERT_TRUE(report.usable);
  ASSERT_TRUE(graph.landmarkCovariances());
  std::cout << "1500 poses, 30 landmarks, 5000 sightings: built in " << built - start << " ms, solved in "
            << solved - built << " ms (" << report.iterations << " iterations), covariances in "
            << now_ms() - solved << " ms\n";
}

}  // namespace
}  // namespace roomgraph::test
