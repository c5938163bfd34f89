// SPDX-License-Identifier: BSD-3-Clause
// What each term of the CRF decides in scenes with known truth, against unary selection and without the term.
#include "selection_scenes.h"

#include <gtest/gtest.h>

#include <ostream>

namespace roomgraph::test {
namespace {

constexpr unsigned kFirstSeed = 1001, kSeeds = 60;  // link_weight was tried on seeds 1 to 100

SceneCounts crf(Scene (*scene)(unsigned), const std::string& keys = "") {
  return countOver(scene, "CrfSelector", keys, kFirstSeed, kSeeds);
}
SceneCounts unary(Scene (*scene)(unsigned), const std::string& keys = "") {
  return countOver(scene, "UnarySelector", keys, kFirstSeed, kSeeds);
}

TEST(SelectionScenes, AreTheSameForTheSameSeed) {
  const Scene a = boxFlickers(3), b = boxFlickers(3), c = boxFlickers(4);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t f = 0; f < a.size(); ++f) {
    ASSERT_EQ(a[f].objects, b[f].objects);
    for (std::size_t j = 0; j < a[f].objects.size(); ++j)
      EXPECT_EQ(a[f].proposals.detections[j].box, b[f].proposals.detections[j].box);
  }
  EXPECT_FALSE(a[0].proposals.detections[0].box == c[0].proposals.detections[0].box);
}

// A scene and by how much more of its detections get the right proposal by the pairwise term than by the
// unary.
struct Gain {
  std::string name;
  Scene (*scene)(unsigned);
  double margin;
};
void PrintTo(const Gain& gain, std::ostream* out) {
  *out << gain.name;
}
class PairwiseTerm : public ::testing::TestWithParam<Gain> {};

TEST_P(PairwiseTerm, BeatsTheUnaryChoice) {
  const Gain& gain = GetParam();
  const SceneCounts alone = unary(gain.scene), linked = crf(gain.scene);
  EXPECT_GT(alone.detections, 500);
  EXPECT_LT(alone.rightShare(), 0.96) << "the frames alone mislead";
  EXPECT_GT(linked.rightShare(), alone.rightShare() + gain.margin);
  EXPECT_LT(linked.brierScore(), 0.8 * alone.brierScore()) << "confidences agree better with the truth, too";
  EXPECT_EQ(linked.right + linked.wrong, alone.right + alone.wrong) << "nothing was left out for it";
}

// The paper's weight, s (1 - beta), does not: most of the time the labels in view stay the same.
TEST_P(PairwiseTerm, DoesNotReachTheMarginWithThePapersWeight) {
  const Gain& gain = GetParam();
  EXPECT_LT(crf(gain.scene, "link_weight = 0").rightShare(), unary(gain.scene).rightShare() + gain.margin);
}

INSTANTIATE_TEST_SUITE_P(Scenes, PairwiseTerm,
                         ::testing::Values(Gain{"OccluderEnters", occluderEnters, 0.04},
                                           Gain{"BoxFlickers", boxFlickers, 0.005},
                                           Gain{"TwoDepthsCompete", twoDepthsCompete, 0.07},
                                           Gain{"ChairsChangeOrder", chairsChangeOrder, 0.02}),
                         [](const auto& test) { return test.param.name; });

// Beta counts by itself when an occluder comes into view: the codes differ for a frame. Where they never do,
// the paper's weight leaves the unary choice.
TEST(SemanticCodes, TheirDifferenceWeighsTheLinks) {
  EXPECT_GT(crf(occluderEnters, "link_weight = 0").rightShare(), unary(occluderEnters).rightShare() + 0.008);
  for (const auto scene : {twoDepthsCompete, chairsChangeOrder})
    EXPECT_EQ(crf(scene, "link_weight = 0").right, unary(scene).right);
}

// Where the frames before are wrong, consistency with them must not cost much.
TEST(SelectionScenes, LinksCostLittleWhereTheFramesBeforeAreWrong) {
  EXPECT_GT(crf(occluderLeaves).rightShare(), unary(occluderLeaves).rightShare() - 0.015);
  EXPECT_GT(crf(chairIsMoved).rightShare(), unary(chairIsMoved).rightShare());
}

TEST(SemanticCodes, OrderTellsChairsOfARowApartWhenThePoseJerks) {
  const double with = crf(jerkyRow).identityShare();
  EXPECT_GT(with, crf(jerkyRow, "order_bonus = 0").identityShare() + 0.02);
  EXPECT_GT(with, 0.88);
}

TEST(Tracks, StayWithTheObjects) {
  EXPECT_GT(crf(chairsChangeOrder).identityShare(), 0.97);
  EXPECT_EQ(crf(occluderEnters).identityShare(), 1);
  EXPECT_GT(crf(boxFlickers).identityShare(), 0.9);
}

// A chair that no frame alone is sure of is remembered once it was followed for a whole window; false alarms,
// each as good as the chair but gone sooner, are not.
TEST(HighOrderTerm, RemembersAWeakObjectButNotFalseAlarms) {
  const SceneCounts alone = unary(weakObject), held = crf(weakObject, "none_competes = true");
  EXPECT_LT(alone.rightShare(), 0.15);
  EXPECT_GT(held.rightShare(), 0.75);
  EXPECT_GT(held.false_alarms, 300);
  EXPECT_LT(held.falseShare(), alone.falseShare() + 0.07);
  // No other bound of the unary energy does that.
  for (const char* bound : {"-0.14", "-0.12", "-0.1", "-0.08", "-0.06"}) {
    const SceneCounts bounded = unary(weakObject, std::string("max_energy = ") + bound);
    EXPECT_LT(bounded.rightShare(), bounded.falseShare() + 0.05) << bound;
  }
}

TEST(HighOrderTerm, DecidesNothingWhenItDoesNotBindOrNoneDoesNotCompete) {
  const SceneCounts alone = unary(weakObject);
  const SceneCounts unbound = crf(weakObject, "none_competes = true\nwindow_frames = 100");  // scenes have 20
  EXPECT_LT(unbound.rightShare(), alone.rightShare() + 0.02);
  const SceneCounts forced = crf(weakObject);
  EXPECT_EQ(forced.right, alone.right);
  EXPECT_EQ(forced.false_selected, alone.false_selected);
}

}  // namespace
}  // namespace roomgraph::test
