// SPDX-License-Identifier: BSD-3-Clause
// Unary potential by hand values, and UnarySelector's choices and confidences.
#include "unary_selector.h"
#include "potentials.h"

#include <gtest/gtest.h>

#include <cmath>

#include "random_poses.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/config.h"
#include "roomgraph/selection/register_classes.h"

namespace roomgraph::test {
namespace {

Detection detectionAt(const Box2& box, double score) {
  Detection detection;
  detection.box = box;
  detection.class_name = "sofa";
  detection.score = score;
  return detection;
}

Proposal proposalFor(int detection, const Box2& visible, double box_iou, double score = 1) {
  Proposal proposal;
  proposal.detection = detection;
  proposal.projected.full = proposal.projected.visible = visible;
  proposal.box_iou = box_iou;
  proposal.score = score;
  return proposal;
}

const Box2 kBox{100, 100, 130, 140};  // diagonal 50 px

std::vector<ObjectMeasurement> select(const FrameProposals& frame, const std::string& config = "") {
  UnarySelector selector;
  Config::fromText("[selection]\n" + config).read("selection", selector);
  return selector.select(frame, {});
}

TEST(UnaryPotential, IsTheOverlapLessTheDistanceOfTheCentres) {
  const Detection detection = detectionAt(kBox, 0.9);
  EXPECT_DOUBLE_EQ(unaryPotential(proposalFor(0, kBox, 1), detection), -1);
  // Moved by (6, 8) px: 10 px of a diagonal of 50: d = 0.2; U = -0.5 (1 - 0.2).
  EXPECT_DOUBLE_EQ(unaryPotential(proposalFor(0, {106, 108, 136, 148}, 0.5), detection), -0.4);
  // Farther away than the diagonal: nothing speaks for it.
  EXPECT_DOUBLE_EQ(unaryPotential(proposalFor(0, {300, 300, 330, 340}, 0.5), detection), 0);
  EXPECT_DOUBLE_EQ(unaryPotential(proposalFor(0, kBox, 1), detectionAt({5, 5, 5, 5}, 0.9)), 0);
}

TEST(UnaryPotential, LiesBetweenMinusOneAndZero) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const double u = random.uniform(0, 300), v = random.uniform(0, 300);
    const double potential = unaryPotential(proposalFor(0, {u, v, u + 40, v + 30}, random.uniform(0, 1)),
                                            detectionAt(kBox, random.uniform(0, 1)));
    EXPECT_GE(potential, -1);
    EXPECT_LE(potential, 0);
  }
}

TEST(UnarySelector, TakesTheBestProposalOfEachDetection) {
  FrameProposals frame;
  frame.frame = FrameId{12};
  frame.t = 3.5;
  frame.detections = {detectionAt(kBox, 0.8), detectionAt({0, 0, 30, 40}, 0.9)};
  frame.proposals = {proposalFor(1, {0, 0, 30, 40}, 0.7), proposalFor(0, {106, 108, 136, 148}, 0.9),
                     proposalFor(0, kBox, 0.8), proposalFor(1, {20, 20, 50, 60}, 0.9)};
  const auto chosen = select(frame);
  ASSERT_EQ(chosen.size(), 2u);
  EXPECT_EQ(chosen[0].proposal.projected.visible, kBox);  // -0.8 beats -0.9 * 0.8
  EXPECT_EQ(chosen[0].detection.box, kBox);
  EXPECT_EQ(chosen[1].proposal.projected.visible, frame.detections[1].box);
  EXPECT_EQ(chosen[0].frame.value, 12);
  EXPECT_EQ(chosen[0].t, 3.5);
  EXPECT_DOUBLE_EQ(chosen[0].energy.unary, -0.8 * 0.8);
}

TEST(UnarySelector, GeneratorsScoreBreaksTies) {
  FrameProposals frame;
  frame.detections = {detectionAt(kBox, 1)};
  frame.proposals = {proposalFor(0, kBox, 0.8, 0.4), proposalFor(0, kBox, 0.8, 0.9),
                     proposalFor(0, kBox, 0.8, 0.5)};
  const auto chosen = select(frame);
  ASSERT_EQ(chosen.size(), 1u);
  EXPECT_EQ(chosen[0].proposal.score, 0.9);
}

TEST(UnarySelector, NothingIsBetterThanABadProposal) {
  FrameProposals frame;
  frame.detections = {detectionAt(kBox, 0.5)};
  EXPECT_TRUE(select(frame).empty()) << "no proposal";
  frame.proposals = {proposalFor(0, kBox, 0.5)};  // energy -0.25
  EXPECT_EQ(select(frame, "max_energy = -0.24").size(), 1u);
  EXPECT_TRUE(select(frame, "max_energy = -0.26").empty());
}

// The confidences of all states, {none} and one per proposal, sum to 1: each is worked out from the energies.
TEST(UnarySelector, ConfidenceIsTheBoltzmannProbability) {
  FrameProposals frame;
  frame.detections = {detectionAt(kBox, 0.8)};
  frame.proposals = {proposalFor(0, kBox, 0.5), proposalFor(0, kBox, 1), proposalFor(0, kBox, 0.25)};
  const double energies[] = {0, -0.4, -0.8, -0.2};  // none, then alpha U
  double sum = 0;
  for (double energy : energies) sum += std::exp(-energy / 0.2);
  const auto chosen = select(frame, "temperature = 0.2");
  ASSERT_EQ(chosen.size(), 1u);
  EXPECT_NEAR(chosen[0].confidence, std::exp(0.8 / 0.2) / sum, 1e-12);

  // One proposal at a time against the same rivals, so every state's confidence is seen; they sum to 1.
  double total = std::exp(0.0) / sum;
  for (int winner = 0; winner < 3; ++winner) {
    double rivals = 1;
    for (int i = 0; i < 3; ++i) rivals += i == winner ? 0 : std::exp(-energies[i + 1] / 0.2);
    FrameProposals alone = frame;
    alone.proposals = {frame.proposals[static_cast<std::size_t>(winner)]};
    const auto only = select(alone, "temperature = 0.2");
    ASSERT_EQ(only.size(), 1u);
    const double odds = only[0].confidence / (1 - only[0].confidence);  // against "none" alone
    total += odds / (odds + rivals);
  }
  EXPECT_NEAR(total, 1, 1e-12);
}

TEST(UnarySelector, IsAtMostOnePerDetectionWhateverComes) {
  Random random(8);
  for (int round = 0; round < 50; ++round) {
    FrameProposals frame;
    for (int j = 0; j < 4; ++j) {
      const double u = random.uniform(0, 200);
      frame.detections.push_back(detectionAt({u, u, u + 40, u + 60}, random.uniform(0.2, 1)));
    }
    for (int k = 0; k < 20; ++k) {
      const double u = random.uniform(0, 200);
      frame.proposals.push_back(
          proposalFor(random.index(5) - 1, {u, u, u + 40, u + 60}, random.uniform(0, 1)));
    }
    std::vector<int> seen;
    for (const auto& measurement : select(frame, "max_energy = 0")) {
      seen.push_back(measurement.proposal.detection);
      EXPECT_EQ(measurement.detection.box, frame.detections[static_cast<std::size_t>(seen.back())].box);
      EXPECT_GT(measurement.confidence, 0);
      EXPECT_LE(measurement.confidence, 1);
    }
    EXPECT_TRUE(std::adjacent_find(seen.begin(), seen.end(), std::greater_equal<>()) == seen.end());
  }
}

TEST(UnarySelector, IsMadeByName) {
  selection::registerClasses();
  selection::registerClasses();
  EXPECT_TRUE(createStage<ProposalSelector>("UnarySelector", "test"));
}

}  // namespace
}  // namespace roomgraph::test
