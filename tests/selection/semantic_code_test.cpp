// SPDX-License-Identifier: BSD-3-Clause
// Semantic codes: reading order, matching against all subsequences, identity links.
#include "semantic_code.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "random_poses.h"

namespace roomgraph::test {
namespace {

LabelledBox boxAt(double u, double v, std::uint8_t label, double size = 20) {
  return {{u - size / 2, v - size / 2, u + size / 2, v + size / 2}, label};
}

SemanticCode codeOf(const std::vector<std::uint8_t>& labels) {
  std::vector<LabelledBox> row;
  for (std::size_t i = 0; i < labels.size(); ++i)
    row.push_back(boxAt(30.0 * static_cast<double>(i), 0, labels[i]));
  return semanticCode(row);
}

TEST(LabelCodes, StayTheSame) {
  LabelCodes codes;
  EXPECT_EQ(codes.of("chair"), 0);
  EXPECT_EQ(codes.of("sofa"), 1);
  EXPECT_EQ(codes.of("chair"), 0);
  for (int i = 2; i < 256; ++i) EXPECT_EQ(codes.of("class " + std::to_string(i)), i);
  EXPECT_THROW(codes.of("one too many"), std::length_error);
  EXPECT_EQ(codes.of("sofa"), 1);
}

TEST(SemanticCode, ReadsRowsFromTopLeftToBottomRight) {
  const std::vector<LabelledBox> objects = {boxAt(300, 205, 5), boxAt(100, 103, 2), boxAt(200, 95, 3),
                                            boxAt(50, 200, 4), boxAt(0, 100, 1)};
  const SemanticCode code = semanticCode(objects);
  EXPECT_EQ(code.labels, (std::vector<std::uint8_t>{1, 2, 3, 4, 5}));
  EXPECT_EQ(code.objects, (std::vector<int>{4, 1, 2, 3, 0}));
  EXPECT_EQ(code.bits(), 40);
  EXPECT_EQ(semanticCode({}).bits(), 0);
}

TEST(SemanticCode, HoldsEveryObjectOnceWhateverComes) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    Random random(seed);
    for (int round = 0; round < 50; ++round) {
      std::vector<LabelledBox> objects;
      for (int i = random.index(9); i > 0; --i)
        objects.push_back(boxAt(random.index(4) * 40, random.index(4) * 40,
                                static_cast<std::uint8_t>(random.index(3)), random.uniform(-5, 200)));
      const SemanticCode code = semanticCode(objects);
      std::vector<int> sorted = code.objects;
      std::sort(sorted.begin(), sorted.end());
      ASSERT_EQ(sorted.size(), objects.size());
      for (std::size_t i = 0; i < sorted.size(); ++i) {
        EXPECT_EQ(sorted[i], static_cast<int>(i));
        EXPECT_EQ(code.labels[i], objects[static_cast<std::size_t>(code.objects[i])].label);
      }
    }
  }
}

TEST(MatchCodes, BetaIsTheSharedOverAllBits) {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(9, 9);
  const auto beta = [&](const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    return matchCodes(codeOf(a), codeOf(b), none).beta;
  };
  EXPECT_EQ(beta({1, 2, 3}, {1, 2, 3}), 1);
  EXPECT_EQ(beta({1, 2, 3}, {4, 5}), 0);
  EXPECT_EQ(beta({1, 2, 3, 4}, {2, 9, 4}), 2.0 / 5);
  EXPECT_EQ(beta({1, 2}, {2, 1}), 1.0 / 3);  // order counts
  EXPECT_EQ(beta({}, {1}), 0);
  EXPECT_EQ(beta({}, {}), 1);
}

// Every common subsequence, tried out.
void bestSubsequence(const SemanticCode& a, const SemanticCode& b, const Eigen::MatrixXd& overlap,
                     std::size_t i, std::size_t k, std::pair<int, double> sofar,
                     std::pair<int, double>& best) {
  best = std::max(best, sofar);
  for (std::size_t p = i; p < a.labels.size(); ++p)
    for (std::size_t q = k; q < b.labels.size(); ++q)
      if (a.labels[p] == b.labels[q])
        bestSubsequence(a, b, overlap, p + 1, q + 1,
                        {sofar.first + 1, sofar.second + overlap(a.objects[p], b.objects[q])}, best);
}

TEST(MatchCodes, AgreesWithTryingEverySubsequence) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    Random random(seed);
    for (int round = 0; round < 100; ++round) {
      const auto randomObjects = [&] {
        std::vector<LabelledBox> objects;
        for (int i = random.index(6); i > 0; --i)
          objects.push_back(boxAt(random.uniform(0, 600), random.uniform(0, 400),
                                  static_cast<std::uint8_t>(random.index(2)), 80));
        return objects;
      };
      const SemanticCode a = semanticCode(randomObjects()), b = semanticCode(randomObjects());
      Eigen::MatrixXd overlap(a.labels.size(), b.labels.size());
      for (Eigen::Index i = 0; i < overlap.size(); ++i) overlap(i) = 0.25 * random.index(5);  // ties too
      std::pair<int, double> best{0, 0.0};
      bestSubsequence(a, b, overlap, 0, 0, {0, 0.0}, best);

      const CodeMatch match = matchCodes(a, b, overlap);
      ASSERT_EQ(match.gamma.size(), b.labels.size());
      std::pair<int, double> found{0, 0.0};
      int last = -1;
      for (std::size_t q = 0; q < b.labels.size(); ++q) {
        const int i = match.gamma[static_cast<std::size_t>(b.objects[q])];
        if (i < 0) continue;
        const auto p = std::find(a.objects.begin(), a.objects.end(), i) - a.objects.begin();
        EXPECT_GT(p, last) << "order is kept";
        last = static_cast<int>(p);
        EXPECT_EQ(a.labels[static_cast<std::size_t>(p)], b.labels[q]);
        found = {found.first + 1, found.second + overlap(i, b.objects[q])};
      }
      EXPECT_EQ(found.first, best.first);
      EXPECT_NEAR(found.second, best.second, 1e-12);
      const int all = static_cast<int>(a.labels.size() + b.labels.size()) - best.first;
      EXPECT_DOUBLE_EQ(match.beta, all > 0 ? static_cast<double>(best.first) / all : 1);
    }
  }
}

// A chair came in at the left: by the labels alone it could be either; the overlap tells.
TEST(MatchCodes, OverlapDecidesBetweenEqualLengths) {
  Eigen::MatrixXd overlap(1, 2);
  overlap << 0.1, 0.8;
  EXPECT_EQ(matchCodes(codeOf({7}), codeOf({7, 7}), overlap).gamma, (std::vector<int>{-1, 0}));
  overlap << 0.8, 0.1;
  EXPECT_EQ(matchCodes(codeOf({7}), codeOf({7, 7}), overlap).gamma, (std::vector<int>{0, -1}));
}

TEST(IdentityLinks, FollowTheMotionWhereTwoObjectsChangePlaces) {
  Eigen::MatrixXd overlap(2, 2);
  overlap << 0.4, 0.9, 0.9, 0.4;
  const SemanticCode a = codeOf({7, 7}), b = codeOf({7, 7});
  const CodeMatch match = matchCodes(a, b, overlap);
  EXPECT_EQ(match.gamma, (std::vector<int>{0, 1})) << "the longest common subsequence cannot cross";
  EXPECT_EQ(match.beta, 1);
  EXPECT_EQ(identityLinks(a, b, match, overlap, 0.2, 0.1), (std::vector<int>{1, 0}));
}

TEST(IdentityLinks, FollowTheOrderWhereTheMotionSaysNothing) {
  const Eigen::MatrixXd overlap = Eigen::MatrixXd::Constant(2, 2, 0.3);
  const SemanticCode a = codeOf({7, 7}), b = codeOf({7, 7});
  EXPECT_EQ(identityLinks(a, b, matchCodes(a, b, overlap), overlap, 0.2, 0.1), (std::vector<int>{0, 1}));
}

// The more gamma's word weighs, the more overlap speaks against it in vain.
TEST(IdentityLinks, TheBonusOfTheOrderIsWeighedAgainstTheOverlap) {
  Eigen::MatrixXd overlap(2, 2);
  overlap << 0.3, 0.45, 0.45, 0.3;
  const SemanticCode a = codeOf({7, 7}), b = codeOf({7, 7});
  const CodeMatch match = matchCodes(a, b, overlap);
  EXPECT_EQ(identityLinks(a, b, match, overlap, 0.2, 0), (std::vector<int>{1, 0}));
  EXPECT_EQ(identityLinks(a, b, match, overlap, 0.2, 0.1), (std::vector<int>{1, 0}));
  EXPECT_EQ(identityLinks(a, b, match, overlap, 0.2, 0.2), (std::vector<int>{0, 1}));
}

TEST(IdentityLinks, NeedOverlapAndTheSameLabel) {
  Eigen::MatrixXd overlap(2, 2);
  overlap << 0, 0.9, 0.9, 0.19;
  const SemanticCode a = codeOf({7, 8}), b = codeOf({7, 8});
  const CodeMatch match = matchCodes(a, b, overlap);
  EXPECT_EQ(match.gamma, (std::vector<int>{0, 1}));
  EXPECT_EQ(identityLinks(a, b, match, overlap, 0.2, 0.1), (std::vector<int>{-1, -1}));
}

}  // namespace
}  // namespace roomgraph::test
