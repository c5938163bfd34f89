// SPDX-License-Identifier: BSD-3-Clause
// Movements between the same two bodies as one: their optimum, their slope where robust losses weigh them, what is left alone.
#include "movement_sum.h"

#include <gtest/gtest.h>

#include <random>

#include "roomgraph/backend/factor_graph.h"

namespace roomgraph {
namespace {

const NodeId kA{0}, kB{1};
const Pose3 kTrue = poseFromYpr(2, -1, 0.3, 0.7, 0.1, -0.2);

class Movements {
 public:
  explicit Movements(unsigned seed) : random_(seed) {}

  Pose3 near(const Pose3& pose, double sigma) {
    return pose * poseFromYpr(normal(sigma), normal(sigma), normal(sigma), normal(sigma), normal(sigma), normal(sigma));
  }
  Matrix6d covariance() {
    Matrix6d root;
    for (double& value : root.reshaped()) value = normal(0.004);
    return root * root.transpose() + 1e-4 * Matrix6d::Identity();
  }
  std::vector<BetweenFactor> around(const Pose3& a_from_b, int count, double sigma, double width) {
    std::vector<BetweenFactor> out;
    for (int i = 0; i < count; ++i) out.push_back({kA, kB, near(a_from_b, sigma), covariance(), width});
    return out;
  }

 private:
  double normal(double sigma) { return std::normal_distribution<double>(0, sigma)(random_); }
  std::mt19937 random_;
};

FactorGraph graphOf(const std::vector<BetweenFactor>& factors, const Pose3& a_from_b) {
  FactorGraph graph;
  graph.addPose(kA, Pose3::Identity(), true);
  graph.addPose(kB, a_from_b);
  for (const BetweenFactor& factor : factors) graph.add(factor);
  return graph;
}

BetweenFactor sumOf(const std::vector<BetweenFactor>& factors, const Pose3& near) {
  MovementSum sum(near);
  for (const BetweenFactor& factor : factors) sum.add(factor);
  return sum.asOne();
}

TEST(MovementSum, ItsOptimumIsThatOfAll) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Movements movements(seed);
    const auto factors = movements.around(kTrue, 8, 0.003, 0);
    FactorGraph all = graphOf(factors, kTrue);
    ASSERT_TRUE(all.optimize({.max_iterations = 100, .function_tolerance = 1e-14}).usable);
    const BetweenFactor one = sumOf(factors, movements.near(kTrue, 0.003));
    const Pose3 difference = one.a_from_b.inverse() * all.pose(kB);
    EXPECT_LT(difference.translation().norm(), 1e-5) << seed;
    EXPECT_LT(rotationAngle(difference), 1e-5) << seed;
    EXPECT_GT((kTrue.inverse() * all.pose(kB)).translation().norm(), 2e-4) << "measurements without errors prove nothing";
    EXPECT_EQ(one.robust_width, 0);
  }
}

// Moved by the same from its optimum each costs the same more.
TEST(MovementSum, ItRisesAsAllDo) {
  Movements movements(3);
  const auto factors = movements.around(kTrue, 6, 0.005, 0);
  const BetweenFactor one = sumOf(factors, kTrue);
  const auto rise = [&](const std::vector<BetweenFactor>& of, const Pose3& step) {
    return graphOf(of, one.a_from_b * step).chiSquared() - graphOf(of, one.a_from_b).chiSquared();
  };
  for (int i = 0; i < 6; ++i) {
    Pose3 step = Pose3::Identity();
    if (i < 3)
      step.translation()[i] = 0.02;
    else
      step.linear() = Eigen::AngleAxisd(0.02, Eigen::Vector3d::Unit(i - 3)).toRotationMatrix();
    EXPECT_NEAR(rise({one}, step), rise(factors, step), 0.03 * rise(factors, step)) << i;
  }
}

// Cauchy's loss of an outlier weighs it as where the sum is taken: the slopes there are the same.
TEST(MovementSum, ItsSlopeIsThatOfTheRobustLosses) {
  Movements movements(4);
  auto factors = movements.around(kTrue, 4, 0.003, 1);
  factors.push_back({kA, kB, movements.near(kTrue, 0.1), movements.covariance(), 1});
  const Pose3 here = kTrue * poseFromYpr(0.006, -0.006, 0.006, 0.006, -0.006, 0.006);
  const BetweenFactor one = sumOf(factors, here);
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 6; ++i) {
    const auto slope = [&](const std::vector<BetweenFactor>& of) {
      const auto at = [&](double length) {
        Pose3 step = Pose3::Identity();
        if (i < 3)
          step.translation()[i] = length;
        else
          step.linear() = Eigen::AngleAxisd(length, Eigen::Vector3d::Unit(i - 3)).toRotationMatrix();
        return graphOf(of, here * step).chiSquared();
      };
      return (at(kStep) - at(-kStep)) / (2 * kStep);
    };
    EXPECT_NEAR(slope({one}), slope(factors), 0.03 * std::abs(slope(factors)) + 1) << i;
    EXPECT_GT(std::abs(slope(factors)), 10) << i << ": a slope of nothing proves nothing";
  }
}

TEST(MovementSum, OneAloneStaysAsItIs) {
  Movements movements(5);
  const auto factors = movements.around(kTrue, 1, 0.1, 2.5);
  const BetweenFactor one = sumOf(factors, Pose3::Identity());
  EXPECT_EQ(one.a_from_b.matrix(), factors[0].a_from_b.matrix());
  EXPECT_EQ(one.covariance, factors[0].covariance);
  EXPECT_EQ(one.robust_width, 2.5);
}

// Bodies of poses 0 and 1, 2 and 3; pose 4 alone. World is held by a pose 5.
struct Bodies {
  explicit Bodies(bool summed, unsigned seed = 6) {
    const Pose3 poses[] = {Pose3::Identity(), poseFromYpr(0.4, 0.1, 0, 0.2, 0, 0), poseFromYpr(2, 1, 0, 1, 0, 0),
                           poseFromYpr(2.3, 1.4, 0, 1.2, 0, 0), poseFromYpr(3, 2, 0, 1.5, 0, 0)};
    graph.addPose(NodeId{5}, Pose3::Identity(), true);
    graph.addPose(NodeId{0}, poses[0]);
    graph.addPose(NodeId{2}, poses[2]);
    graph.addPose(NodeId{4}, poses[4]);
    graph.attach(NodeId{1}, NodeId{0}, poses[1]);
    graph.attach(NodeId{3}, NodeId{2}, poses[3]);
    Movements movements(seed);
    const auto between = [&](int a, int b) {
      const Pose3 a_from_b = poses[a].inverse() * poses[b];
      return BetweenFactor{NodeId{a}, NodeId{b}, movements.near(a_from_b, 0.003), movements.covariance(), 0};
    };
    graph.add(BetweenFactor{NodeId{5}, NodeId{0}, Pose3::Identity(), 1e-4 * Matrix6d::Identity(), 0});
    for (const auto& [a, b] : {std::pair{0, 2}, {1, 2}, {1, 3}, {0, 3}, {0, 1}, {3, 4}, {1, 4}}) {
      const BetweenFactor factor = between(a, b);
      if (summed)
        graph.addToSum(factor);
      else
        graph.add(factor);
    }
  }
  FactorGraph graph;
};

TEST(MovementSum, MovementsBetweenTwoBodiesBecomeOneFactor) {
  for (unsigned seed = 6; seed < 12; ++seed) {
    Bodies each(false, seed), summed(true, seed);
    EXPECT_EQ(each.graph.factors(), 7u);
    EXPECT_EQ(summed.graph.factors(), 3u) << "those of a single pose are there at once, one within a body never";
    summed.graph.addSums();
    EXPECT_EQ(summed.graph.factors(), 4u);
    summed.graph.addSums();
    EXPECT_EQ(summed.graph.factors(), 4u) << "once";
    ASSERT_TRUE(each.graph.optimize({.max_iterations = 100, .function_tolerance = 1e-14}).usable);
    ASSERT_TRUE(summed.graph.optimize({.max_iterations = 100, .function_tolerance = 1e-14}).usable);
    for (int i = 0; i < 5; ++i) {
      const Pose3 difference = each.graph.pose(NodeId{i}).inverse() * summed.graph.pose(NodeId{i});
      EXPECT_LT(difference.translation().norm(), 1e-4) << "pose " << i << ", seed " << seed;
      EXPECT_LT(rotationAngle(difference), 1e-4) << "pose " << i << ", seed " << seed;
    }
    EXPECT_GT((each.graph.pose(NodeId{2}).translation() - Eigen::Vector3d(2, 1, 0)).norm(), 3e-4) << seed;
  }
}

}  // namespace
}  // namespace roomgraph
